/* shade.c - the last stage: the mesh and triangle that a pixel of the colour image holds become radiance. Flat Lambert shading
 * from scene-format.md: albedo / pi (ambient + sum over lights of E max(0, n l) V). */
#include "raster/raster.h"

#include "check.h"
#include "lanes/lanes.h"
#include "num.h"
#include "vec.h"

/* A texture, ready for offsets. */
typedef struct texture {
    const tyn_image *image; /* NULL: none */
    const void *pixels;
    int32_t stride, bytes; /* of a row, of a texel */
    int32_t last_word;     /* of bytes: where the image's last whole word begins */
    float unit;
    int plain; /* kernels can read it */
} texture;

/* The mesh and the row at hand. */
typedef struct shader {
    const tyni_raster_shading *s;
    tyni_raster_face
        *faces;      /* TYNI_RASTER_FACES of them, each in a place of its own: a row's triangles are the next one's too */
    uint32_t mesh;   /* that albedo and texture are of */
    float albedo[3]; /* divided by pi */
    texture texture;
    void *group;          /* of the kernel; TYNI_RASTER_GROUP bytes */
    tyni_vec3 ray, right; /* of a pixel at depth 1: ray + x right */
    float middle, half, step;
    int32_t in_order;
    uint32_t last_mesh, last_triangle; /* in order: the face at hand */
    tyni_raster_slopes *slopes;        /* and its slopes, a light's each */
} shader;

static void set_texture(texture *t, const tyn_mesh *mesh)
{
    const tyn_image *image = mesh->texcoords ? mesh->material.texture : NULL;
    ptrdiff_t stride, rows;
    memset(t, 0, sizeof *t);
    t->image = image;
    if (!image)
        return;
    stride = tyni_image_stride(image);
    rows = stride < 0 ? -stride : stride;
    t->pixels = image->pixels;
    t->bytes = tyn_format_bytes(image->format);
    t->unit = t->bytes == 3 ? 1.0f / 255.0f : 1.0f / 65535.0f;
    /* offsets in 32 bits, and a whole word around any texel of bytes */
    t->plain = rows <= INT32_MAX / image->height && (t->bytes != 3 || image->width > 1);
    t->stride = t->plain ? (int32_t)stride : 0;
    t->last_word = 3 * image->width - 4 + (t->plain && stride > 0 ? (int32_t)stride * (image->height - 1) : 0);
}

static void set_growth(tyni_raster_face *f, const tyn_mesh *mesh, const uint32_t *index, const tyni_raster_facet *facet,
                       int flat)
{
    const float *t0 = mesh->texcoords + (size_t)index[0] * 2, *t1 = mesh->texcoords + (size_t)index[1] * 2,
                *t2 = mesh->texcoords + (size_t)index[2] * 2;
    f->u = t0[0];
    f->v = t0[1];
    if (flat)
        return;
    f->grow_u = tyni_raster_gradient(facet, t1[0] - t0[0], t2[0] - t0[0]);
    f->grow_v = tyni_raster_gradient(facet, t1[1] - t0[1], t2[1] - t0[1]);
}

static void set_face(tyni_raster_face *f, const tyni_raster_shading *s, uint32_t mesh_number, uint32_t triangle)
{
    const tyn_mesh *mesh = &s->surface->meshes[mesh_number];
    const uint32_t *index = mesh->indices + (size_t)triangle * 3;
    const tyni_vec3 p0 = tyni_vec_load(mesh->positions + (size_t)index[0] * 3);
    tyni_raster_facet facet;
    const int flat = !tyni_raster_make_facet(p0, tyni_vec_load(mesh->positions + (size_t)index[1] * 3),
                                             tyni_vec_load(mesh->positions + (size_t)index[2] * 3), &facet);
    memset(f, 0, sizeof *f);
    f->mesh = mesh_number;
    f->triangle = triangle;
    f->corner = tyni_vec_sub(p0, tyni_vec_load(s->surface->camera.position));
    f->normal = flat ? tyni_vec(0.0f, 0.0f, 0.0f) : tyni_vec_normalise(facet.normal);
    if (tyni_vec_dot(f->normal, f->corner) > 0.0f)
        f->normal = tyni_vec_scale(f->normal, -1.0f);
    if (mesh->texcoords && mesh->material.texture)
        set_growth(f, mesh, index, &facet, flat);
}

static void dress(shader *sh, uint32_t mesh)
{
    const tyn_mesh *m = &sh->s->surface->meshes[mesh];
    if (sh->mesh == mesh)
        return;
    sh->mesh = mesh;
    for (int32_t c = 0; c < 3; c++)
        sh->albedo[c] = m->material.albedo[c] * (1.0f / TYNI_PI);
    set_texture(&sh->texture, m);
}

/* The face of a triangle; NULL where it would take the place of one of `used`. */
static const tyni_raster_face *take_face(shader *sh, uint32_t mesh, uint32_t triangle, const tyni_raster_face *const *used,
                                         int32_t count)
{
    tyni_raster_face *f = &sh->faces[(triangle ^ triangle >> 6 ^ mesh * 29u) % TYNI_RASTER_FACES];
    if (f->mesh != mesh || f->triangle != triangle) {
        for (int32_t i = 0; i < count; i++)
            if (used[i] == f)
                return NULL;
        set_face(f, sh->s, mesh, triangle);
    }
    if (sh->in_order && (sh->last_mesh != mesh || sh->last_triangle != triangle)) {
        sh->last_mesh = mesh;
        sh->last_triangle = triangle;
        for (int32_t i = 0; i < sh->s->surface->light_count; i++)
            sh->slopes[i].ready = 0;
    }
    return f;
}

/* How z changes on a face over map k of light i. Of a perspective map it is calculated at the first pixel of a row that the
 * map covers, which is a matter of rounding: those need pixels in order. Of a parallel one it is the same everywhere.
 * NULL: not known yet. */
static const float *known_slopes(const shader *sh, const tyni_raster_face *f, int32_t i, int32_t k)
{
    const int32_t number = sh->s->lamps[i].maps[k].number;
    if (sh->in_order)
        return sh->slopes[i].ready >> k & 1u ? sh->slopes[i].slope[k] : NULL;
    return number < TYNI_RASTER_SLOPES && (f->ready >> number & 1u) ? f->slope[number] : NULL;
}

static const float *find_slopes(shader *sh, const tyni_raster_face *face, int32_t i, int32_t k, tyni_vec3 point)
{
    const tyni_raster_map *map = &sh->s->lamps[i].maps[k];
    tyni_raster_face *f = sh->faces + (face - sh->faces);
    tyni_raster_set_slope(&sh->slopes[i], k, map, point, face->normal);
    if (!sh->in_order && map->number < TYNI_RASTER_SLOPES) {
        memcpy(f->slope[map->number], sh->slopes[i].slope[k], sizeof f->slope[map->number]);
        f->ready |= 1u << map->number;
    }
    return sh->slopes[i].slope[k];
}

/* What a light adds at a point. */
static void add_light(shader *sh, const tyni_raster_face *f, int32_t i, tyni_vec3 point, float sum[3])
{
    const tyni_raster_shading *s = sh->s;
    const tyni_raster_lamp *lamp = &s->lamps[i];
    const tyn_light *light = lamp->light;
    const int sun = light->kind == TYN_LIGHT_DIRECTIONAL;
    float amount = tyni_vec_dot(f->normal, sun ? lamp->towards : tyni_vec_sub(lamp->position, f->corner)), distance = 0.0f,
          rgb[3] = {light->colour[0], light->colour[1], light->colour[2]};
    if (!(amount > 0.0f))
        return;
    if (!sun) {
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
        if (!sh->in_order) /* the face may be another one */
            sh->slopes[i].ready = 0;
        amount *= tyni_raster_visible(lamp, world, f->normal, &sh->slopes[i], rgb);
    }
    if (!(amount > 0.0f))
        return;
    for (int32_t c = 0; c < 3; c++) {
        const float dim = s->hazy && distance > 0.0f ? tyni_num_exp(-s->sigma[c] * distance) : 1.0f;
        sum[c] += rgb[c] * amount * dim;
    }
}

static void begin_row(shader *sh, int32_t y, const float **depth, float **colour)
{
    const tyni_raster_pass *pass = sh->s->pass;
    const tyni_raster_view *view = &pass->view;
    const tyn_camera *camera = &sh->s->surface->camera;
    const float ry = view->middle[1] + ((float)y + 0.5f - view->half[1]) * view->step[1];
    sh->ray = tyni_vec_mad(tyni_vec_load(camera->forward), ry, tyni_vec_load(camera->up));
    *depth = (const float *)(const void *)(pass->depth + y * pass->depth_stride);
    *colour = (float *)(void *)(pass->colour + y * pass->colour_stride);
}

#define TYNI_KERNEL "raster/pixels.h"
#include "lanes/each.h"

/* Whether a pixel's colour depends on the pixels before it, if only by a last place: see slopes_of. */
static int in_order(const tyni_raster_shading *s)
{
    for (int32_t i = 0; i < s->surface->light_count; i++)
        for (int32_t k = 0; k <= s->lamps[i].light->more_count; k++)
            if (tyni_raster_shadow_of(s->lamps[i].light, k)->depth && !s->lamps[i].maps[k].parallel)
                return 1;
    return 0;
}

void tyni_raster_shade(void *argument, int32_t band, int32_t worker)
{
    const tyni_raster_shading *s = argument;
    const tyn_raster *raster = s->pass->raster;
    const tyni_raster_view *view = &s->pass->view;
    const int32_t first = band * TYNI_RASTER_BAND, end = tyni_mini(first + TYNI_RASTER_BAND, view->height);
    shader sh;
    int32_t wide;
    sh.s = s;
    sh.faces = raster->faces + (size_t)worker * TYNI_RASTER_FACES;
    sh.group = raster->groups + (size_t)worker * TYNI_RASTER_GROUP;
    sh.slopes = raster->slopes + (size_t)worker * TYN_MAX_LIGHTS;
    sh.mesh = sh.last_mesh = TYNI_RASTER_NOTHING;
    sh.last_triangle = 0;
    sh.in_order = in_order(s);
    sh.right = tyni_vec_load(s->surface->camera.right);
    sh.middle = view->middle[0];
    sh.half = view->half[0];
    sh.step = view->step[0];
    wide = sh.in_order ? view->width : TYNI_RASTER_BLOCK;
    for (int32_t i = 0; i < TYNI_RASTER_FACES; i++)
        sh.faces[i].mesh = TYNI_RASTER_NOTHING;
    /* down first, where that is free: the next row has the same triangles */
    for (int32_t x = 0; x < view->width; x += wide)
        TYNI_LANES_CALL(raster->isa, raster_shade_area, (&sh, x, tyni_mini(x + wide, view->width), first, end));
}
