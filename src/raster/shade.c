/* shade.c - the last stage: the mesh and triangle that a pixel of the colour image holds become radiance. Flat Lambert shading
 * from scene-format.md: albedo / pi (ambient + sum over lights of E max(0, n l) V). */
#include "raster/raster.h"

#include "num.h"
#include "vec.h"

/* What a triangle's pixels share. Points are relative to the camera. */
typedef struct face {
    uint32_t mesh, triangle;
    tyni_vec3 corner, normal; /* of length 1, towards the camera */
    float albedo[3];          /* divided by pi */
    const tyn_image *texture;
    float u, v; /* at the corner */
    tyni_vec3 grow_u, grow_v;
    float facing[TYN_MAX_LIGHTS]; /* directional: n . l; others: > 0 where it shines on the camera's side */
    tyni_raster_slopes slopes[TYN_MAX_LIGHTS];
} face;

static void set_texture(face *f, const tyn_mesh *mesh, const uint32_t *index, const tyni_raster_facet *facet, int flat)
{
    const float *t0 = mesh->texcoords + (size_t)index[0] * 2, *t1 = mesh->texcoords + (size_t)index[1] * 2,
                *t2 = mesh->texcoords + (size_t)index[2] * 2;
    f->u = t0[0];
    f->v = t0[1];
    f->grow_u = f->grow_v = tyni_vec(0.0f, 0.0f, 0.0f);
    if (flat)
        return;
    f->grow_u = tyni_raster_gradient(facet, t1[0] - t0[0], t2[0] - t0[0]);
    f->grow_v = tyni_raster_gradient(facet, t1[1] - t0[1], t2[1] - t0[1]);
}

static void set_lights(face *f, const tyni_raster_shading *s)
{
    for (int32_t i = 0; i < s->surface->light_count; i++) {
        const tyni_raster_lamp *lamp = &s->lamps[i];
        const int sun = lamp->light->kind == TYN_LIGHT_DIRECTIONAL;
        f->facing[i] = tyni_vec_dot(f->normal, sun ? lamp->towards : tyni_vec_sub(lamp->position, f->corner));
        f->slopes[i].ready = 0;
    }
}

static void set_face(face *f, const tyni_raster_shading *s, uint32_t mesh_number, uint32_t triangle)
{
    const tyn_mesh *mesh = &s->surface->meshes[mesh_number];
    const uint32_t *index = mesh->indices + (size_t)triangle * 3;
    const tyni_vec3 p0 = tyni_vec_load(mesh->positions + (size_t)index[0] * 3);
    tyni_raster_facet facet;
    const int flat = !tyni_raster_make_facet(p0, tyni_vec_load(mesh->positions + (size_t)index[1] * 3),
                                             tyni_vec_load(mesh->positions + (size_t)index[2] * 3), &facet);
    f->mesh = mesh_number;
    f->triangle = triangle;
    f->corner = tyni_vec_sub(p0, tyni_vec_load(s->surface->camera.position));
    f->normal = flat ? tyni_vec(0.0f, 0.0f, 0.0f) : tyni_vec_normalise(facet.normal);
    if (tyni_vec_dot(f->normal, f->corner) > 0.0f)
        f->normal = tyni_vec_scale(f->normal, -1.0f);
    for (int32_t c = 0; c < 3; c++)
        f->albedo[c] = mesh->material.albedo[c] * (1.0f / TYNI_PI);
    f->texture = mesh->texcoords ? mesh->material.texture : NULL;
    if (f->texture)
        set_texture(f, mesh, index, &facet, flat);
    set_lights(f, s);
}

/* What a light adds at a point. */
static void add_light(face *f, const tyni_raster_shading *s, int32_t i, tyni_vec3 point, float sum[3])
{
    const tyni_raster_lamp *lamp = &s->lamps[i];
    const tyn_light *light = lamp->light;
    float amount = f->facing[i], distance = 0.0f, rgb[3] = {light->colour[0], light->colour[1], light->colour[2]};
    if (!(amount > 0.0f))
        return;
    if (light->kind != TYN_LIGHT_DIRECTIONAL) {
        const tyni_vec3 to = tyni_vec_sub(lamp->position, point);
        const float square = tyni_maxf(tyni_vec_dot(to, to), 1e-12f); /* the light touches the surface: finite all the same */
        distance = sqrtf(square);
        if (light->kind == TYN_LIGHT_SPOT && !light->texture_count && tyni_vec_dot(to, lamp->towards) < lamp->cosine * distance)
            return;
        amount = tyni_maxf(tyni_vec_dot(f->normal, to), 0.0f) / (distance * square);
    }
    if (light->texture_count) { /* instead of the cone, a frustum; outside of a gobo, dark */
        float texel[3];
        if (!tyni_slide_colour(lamp->slides, light->texture_count, point, texel))
            return;
        for (int32_t c = 0; c < 3; c++)
            rgb[c] *= texel[c];
    }
    if (lamp->mapped) {
        const tyni_vec3 world = tyni_vec_add(point, tyni_vec_load(s->surface->camera.position));
        amount *= tyni_raster_visible(lamp, world, f->normal, &f->slopes[i], rgb);
    }
    if (!(amount > 0.0f))
        return;
    for (int32_t c = 0; c < 3; c++) {
        const float dim = s->hazy && distance > 0.0f ? tyni_num_exp(-s->sigma[c] * distance) : 1.0f;
        sum[c] += rgb[c] * amount * dim;
    }
}

static void shade_pixel(face *f, const tyni_raster_shading *s, tyni_vec3 point, float rgb[3])
{
    float sum[3] = {s->surface->ambient[0], s->surface->ambient[1], s->surface->ambient[2]};
    for (int32_t i = 0; i < s->surface->light_count; i++)
        add_light(f, s, i, point, sum);
    for (int32_t c = 0; c < 3; c++)
        rgb[c] = f->albedo[c] * sum[c];
    if (f->texture) {
        const tyni_vec3 way = tyni_vec_sub(point, f->corner);
        float texel[3];
        tyni_raster_texel(f->texture, f->u + tyni_vec_dot(f->grow_u, way), f->v + tyni_vec_dot(f->grow_v, way), texel);
        for (int32_t c = 0; c < 3; c++)
            rgb[c] *= texel[c];
    }
    for (int32_t c = 0; c < 3; c++)
        rgb[c] = tyni_clampf(rgb[c], 0.0f, 3e38f);
}

static void shade_row(const tyni_raster_shading *s, int32_t y, face *f)
{
    const tyni_raster_pass *pass = s->pass;
    const tyni_raster_view *view = &pass->view;
    const tyn_camera *camera = &s->surface->camera;
    const tyni_vec3 right = tyni_vec_load(camera->right), up = tyni_vec_load(camera->up);
    const float *depth = (const float *)(const void *)(pass->depth + y * pass->depth_stride);
    uint8_t *colour = pass->colour + y * pass->colour_stride;
    const float ry = view->middle[1] + ((float)y + 0.5f - view->half[1]) * view->step[1];
    const tyni_vec3 ray_row = tyni_vec_mad(tyni_vec_load(camera->forward), ry, up);
    for (int32_t x = 0; x < view->width; x++, colour += 12) {
        const float rx = view->middle[0] + ((float)x + 0.5f - view->half[0]) * view->step[0];
        float rgb[3];
        uint32_t seen[2];
        memcpy(seen, colour, sizeof seen);
        if (seen[0] == TYNI_RASTER_NOTHING) {
            memcpy(colour, s->surface->background, sizeof rgb);
            continue;
        }
        if (seen[0] != f->mesh || seen[1] != f->triangle)
            set_face(f, s, seen[0], seen[1]);
        shade_pixel(f, s, tyni_vec_scale(tyni_vec_mad(ray_row, rx, right), depth[x]), rgb);
        memcpy(colour, rgb, sizeof rgb);
    }
}

void tyni_raster_shade(void *argument, int32_t band, int32_t worker)
{
    const tyni_raster_shading *s = argument;
    const int32_t first = band * TYNI_RASTER_BAND, end = tyni_mini(first + TYNI_RASTER_BAND, s->pass->view.height);
    face f;
    (void)worker;
    f.mesh = TYNI_RASTER_NOTHING;
    f.triangle = 0;
    for (int32_t y = first; y < end; y++)
        shade_row(s, y, &f);
}
