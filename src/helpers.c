/* helpers.c - public calls that fill in the structs of tyndall.h; they need neither level. */
#include "tyndall.h"

#include "base.h"
#include "check.h"
#include "fit.h"
#include "num.h"
#include "slide.h"
#include "vec.h"

static void store(float out[3], tyni_vec3 v)
{
    out[0] = v.x;
    out[1] = v.y;
    out[2] = v.z;
}

tyn_status tyn_camera_look(tyn_camera *camera, const float position[3], const float target[3], const float up[3], float fov_y,
                           float near_depth, float far_depth, int32_t width, int32_t height)
{
    tyni_vec3 forward, right;
    tyn_camera c;
    float sine, cosine, half;
    if (!camera || !position || !target || !up)
        return TYN_E_NULL;
    if (!tyni_check_finite(position, 3) || !tyni_check_finite(target, 3) || !tyni_check_finite(up, 3) ||
        !(fov_y > 0.0f && fov_y < TYNI_PI) || width < 1 || height < 1 || width > TYN_MAX_SIZE || height > TYN_MAX_SIZE)
        return TYN_E_CAMERA;
    forward = tyni_vec_normalise(tyni_vec_sub(tyni_vec_load(target), tyni_vec_load(position)));
    right = tyni_vec_cross(forward, tyni_vec_normalise(tyni_vec_load(up)));
    if (!(tyni_vec_length(right) > 1e-6f))
        return TYN_E_CAMERA;
    right = tyni_vec_normalise(right);
    c.kind = TYN_CAMERA_PERSPECTIVE;
    memcpy(c.position, position, sizeof c.position);
    store(c.forward, forward);
    store(c.right, right);
    store(c.up, tyni_vec_cross(right, forward));
    tyni_num_sincos(0.5f * fov_y, &sine, &cosine);
    half = sine / cosine;
    c.top_edge = half;
    c.bottom_edge = -half;
    c.right_edge = half * (float)width / (float)height;
    c.left_edge = -c.right_edge;
    c.near_depth = near_depth;
    c.far_depth = far_depth;
    if (tyni_check_camera(&c) != TYN_OK)
        return TYN_E_CAMERA;
    *camera = c;
    return TYN_OK;
}

static int about_zero(float a, float b, float size)
{
    return tyni_absf(a) <= 1e-5f * size && tyni_absf(b) <= 1e-5f * size;
}

/* Where a row of a projection (coordinate = scale * x + shift, over w) meets -1 and 1. */
static void edges(float scale, float shift, float w, float *low, float *high)
{
    float a = (-w - shift) / scale, b = (w - shift) / scale;
    *low = tyni_minf(a, b);
    *high = tyni_maxf(a, b);
}

tyn_status tyn_camera_from_matrices(tyn_camera *camera, const float view[16], const float projection[16], float near_depth,
                                    float far_depth)
{
    const float *v = view, *p = projection;
    tyni_vec3 right, up, back, at;
    tyn_camera c;
    int flat;
    if (!camera || !view || !projection)
        return TYN_E_NULL;
    if (!tyni_check_finite(v, 16) || !tyni_check_finite(p, 8) || !tyni_check_finite(p + 12, 4))
        return TYN_E_CAMERA;
    memset(&c, 0, sizeof c);
    /* a turn and a shift: the rows are the axes, and a mirror is none */
    right = tyni_vec_load(v);
    up = tyni_vec_load(v + 4);
    back = tyni_vec_load(v + 8);
    if (!about_zero(v[12], v[13], 1.0f) || !about_zero(v[14], v[15] - 1.0f, 1.0f) ||
        !(tyni_vec_dot(tyni_vec_cross(right, up), back) > 0.0f))
        return TYN_E_CAMERA;
    at = tyni_vec_mad(tyni_vec_mad(tyni_vec_scale(right, -v[3]), -v[7], up), -v[11], back);
    store(c.position, at);
    store(c.right, right);
    store(c.up, up);
    store(c.forward, tyni_vec_scale(back, -1.0f));
    /* w is in proportion to the depth -z (perspective), or constant (orthographic) */
    flat = p[15] > 0.0f && about_zero(p[14], 0.0f, p[15]);
    c.kind = flat ? TYN_CAMERA_ORTHOGRAPHIC : TYN_CAMERA_PERSPECTIVE;
    if (flat ? !about_zero(p[12], p[13], p[15])
             : !(p[14] < 0.0f && about_zero(p[12], p[13], -p[14]) && about_zero(p[15], 0.0f, -p[14])))
        return TYN_E_CAMERA;
    /* x and y each of their own coordinate and a shift, with the depth (1 at the pixel plane) or without it */
    if (!(p[0] > 0.0f) || !about_zero(p[1], flat ? p[2] : p[3], p[0]) ||
        !about_zero(p[4], flat ? p[6] : p[7], tyni_absf(p[5])) || p[5] == 0.0f)
        return TYN_E_CAMERA;
    edges(p[0], flat ? p[3] : -p[2], flat ? p[15] : -p[14], &c.left_edge, &c.right_edge);
    edges(p[5], flat ? p[7] : -p[6], flat ? p[15] : -p[14], &c.bottom_edge, &c.top_edge);
    c.near_depth = near_depth;
    c.far_depth = far_depth;
    if (tyni_check_camera(&c) != TYN_OK)
        return TYN_E_CAMERA;
    *camera = c;
    return TYN_OK;
}

/* Rayleigh and haze, if they are media that a frame may have. */
static tyn_status set_air(tyn_medium media[2], const tyn_medium made[2])
{
    tyn_status status = tyni_check_media(made, 2);
    if (status == TYN_OK)
        memcpy(media, made, 2 * sizeof *media);
    return status;
}

tyn_status tyn_medium_air(tyn_medium media[2], float scale)
{
    tyn_medium made[2] = {{{0}, {0}, TYN_PHASE_RAYLEIGH, 0}, {{0}, {0}, TYN_PHASE_HG, 0.76f}};
    static const float rayleigh[3] = {5.8e-6f, 13.5e-6f, 33.1e-6f};
    if (!media)
        return TYN_E_NULL;
    if (!(scale >= 0.0f))
        return TYN_E_MEDIUM;
    for (int32_t c = 0; c < 3; c++) {
        made[0].scatter[c] = rayleigh[c] * scale;
        made[1].scatter[c] = 2.0e-5f * scale;
    }
    return set_air(media, made);
}

tyn_status tyn_medium_weather(tyn_medium media[2], float turbidity, float visibility, float angstrom)
{
    /* Rayleigh scattering as in tyn_medium_air; its channels are the wavelengths 680, 550 and 440 nm (Bruneton and Neyret 2008)
     */
    static const float rayleigh[3] = {5.8e-6f, 13.5e-6f, 33.1e-6f};
    tyn_medium made[2] = {{{0}, {0}, TYN_PHASE_RAYLEIGH, 0}, {{0}, {0}, TYN_PHASE_HG, 0.76f}};
    static const float log_ratio[3] = {-0.2121745f, 0.0f, 0.2231436f}; /* of 550 nm to the wavelength */
    float air, haze;
    if (!media)
        return TYN_E_NULL;
    if (!tyni_finite(turbidity) || turbidity < 1.0f || !tyni_finite(visibility) || visibility < 0.0f ||
        !(angstrom >= 0.0f && angstrom <= 4.0f))
        return TYN_E_MEDIUM;
    air = visibility > 0.0f ? 3.912f / visibility / turbidity : rayleigh[1];
    haze = air * (turbidity - 1.0f);
    for (int32_t c = 0; c < 3; c++) {
        made[0].scatter[c] = air * (rayleigh[c] / rayleigh[1]);
        made[1].scatter[c] = haze * tyni_num_exp(angstrom * log_ratio[c]);
    }
    return set_air(media, made);
}

static tyn_status check_fit(const tyn_light *light, const tyn_camera *camera)
{
    tyn_status status;
    tyn_light bare;
    if (!light || !camera)
        return TYN_E_NULL;
    if (tyni_check_camera(camera) != TYN_OK)
        return TYN_E_CAMERA;
    bare = *light;
    if (light->kind == TYN_LIGHT_POINT)
        return TYN_E_LIGHT;   /* tyn_shadow_fit_cube */
    bare.shadow.depth = NULL; /* its matrix is what is asked for, whatever it holds now */
    status = tyni_check_lights(&bare, 1, TYN_MAX_SHADOW, TYN_MAX_MAPS);
    return status == TYN_OK ? tyni_slide_check(&bare) : status;
}

static void fit(tyn_light *light, const tyn_camera *camera, const tyn_image *depth, const tyni_fit_casters *casters)
{
    if (light->kind == TYN_LIGHT_DIRECTIONAL)
        tyni_fit_directional(light->shadow.matrix, light, camera, depth, casters);
    else
        tyni_fit_spot(light->shadow.matrix, light, camera, casters);
}

tyn_status tyn_shadow_fit(tyn_light *light, const tyn_camera *camera, const float bounds_min[3], const float bounds_max[3])
{
    tyni_fit_casters casters = {NULL, 0, NULL, NULL};
    tyn_status status = check_fit(light, camera);
    if (status != TYN_OK)
        return status;
    status = tyni_check_bounds(bounds_min, bounds_max);
    if (status != TYN_OK)
        return status;
    casters.low = bounds_min;
    casters.high = bounds_max;
    fit(light, camera, NULL, &casters);
    return TYN_OK;
}

static tyn_status check_mesh(const tyn_mesh *mesh)
{
    if (!mesh->triangles)
        return TYN_OK;
    if (!mesh->positions || !mesh->indices)
        return TYN_E_NULL;
    for (size_t i = 0; i < 3 * (size_t)mesh->triangles; i++)
        if (mesh->indices[i] >= mesh->vertices)
            return TYN_E_MESH;
    return TYN_OK;
}

tyn_status tyn_shadow_fit_scene(tyn_light *light, const tyn_camera *camera, const tyn_image *depth, const tyn_mesh *meshes,
                                int32_t mesh_count)
{
    tyni_fit_casters casters = {NULL, 0, NULL, NULL};
    tyn_status status = check_fit(light, camera);
    if (status != TYN_OK)
        return status;
    if (depth && (status = tyni_check_image(depth, TYNI_FORMAT_BIT(TYN_DEPTH_F32))) != TYN_OK)
        return status;
    if (mesh_count < 0)
        return TYN_E_LIMIT;
    if (mesh_count > 0 && !meshes)
        return TYN_E_NULL;
    for (int32_t i = 0; i < mesh_count; i++)
        if ((status = check_mesh(&meshes[i])) != TYN_OK)
            return status;
    casters.meshes = meshes;
    casters.mesh_count = mesh_count;
    fit(light, camera, depth, &casters);
    return TYN_OK;
}

tyn_status tyn_shadow_fit_cube(tyn_shadow faces[6], const float position[3], float reach)
{
    if (!faces || !position)
        return TYN_E_NULL;
    if (!tyni_check_within(position, 3, TYN_MAX_LENGTH) || !tyni_finite(reach) || !(reach > 0.0f))
        return TYN_E_LIGHT;
    for (int32_t i = 0; i < 6; i++)
        tyni_fit_face(faces[i].matrix, position, i, reach, faces[i].size);
    return TYN_OK;
}
