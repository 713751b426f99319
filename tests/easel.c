/* easel.c - see easel.h */
#include "easel.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "test.h"

#define BAND 64

static void *aligned(size_t bytes)
{
    void *block = NULL;
    if (posix_memalign(&block, TYN_ALIGNMENT, bytes))
        abort();
    return block;
}

easel easel_new(int32_t width, int32_t height, int32_t batch, int32_t workers, int upside_down)
{
    static const float origin[3] = {0, 0, 0}, ahead[3] = {0, 0, -1}, up[3] = {0, 1, 0};
    tyn_raster_config config = {0};
    easel e;
    memset(&e, 0, sizeof e);
    config.width = width;
    config.height = height;
    config.batch = batch;
    config.workers = workers;
    if (tyn_raster_measure(&config, &e.bytes))
        abort();
    e.block = aligned(e.bytes + 2 * BAND);
    memset(e.block, 0xa5, e.bytes + 2 * BAND);
    if (tyn_raster_init(&e.raster, &config, e.block + BAND, e.bytes))
        abort();
    e.depth = guard_new(width, height, TYN_DEPTH_F32, upside_down);
    e.colour = guard_new(width, height, TYN_RGB_F32, upside_down);
    e.surface.depth = e.depth.image;
    e.surface.colour = e.colour.image;
    if (tyn_camera_look(&e.surface.camera, origin, ahead, up, 1.0f, 0.1f, 1000.0f, width, height))
        abort();
    return e;
}

void easel_free(easel *e)
{
    guard_free(&e->depth);
    guard_free(&e->colour);
    free(e->block);
}

int easel_intact(const easel *e)
{
    for (size_t i = 0; i < BAND; i++)
        if (e->block[i] != 0xa5 || e->block[BAND + e->bytes + i] != 0xa5)
            return 0;
    return guard_intact(&e->depth) && guard_intact(&e->colour);
}

tyn_status easel_draw(easel *e, const tyn_mesh *meshes, int32_t count)
{
    tyn_status status;
    e->surface.meshes = meshes;
    e->surface.mesh_count = count;
    e->surface.stats = &e->stats;
    status = tyn_raster_surface(e->raster, &e->surface);
    CHECK(easel_intact(e));
    return status;
}

tyn_status easel_shadow(easel *e, const tyn_shadow *shadow, float *depth, const tyn_mesh *meshes, int32_t count)
{
    tyn_status status = tyn_raster_shadow(e->raster, shadow, depth, meshes, count, NULL, NULL, NULL, &e->stats);
    CHECK(easel_intact(e));
    return status;
}

static const void *pixel(const guard *g, int32_t x, int32_t y)
{
    return (const uint8_t *)g->image.pixels + g->image.stride * y + (ptrdiff_t)tyn_format_bytes(g->image.format) * x;
}

float easel_depth(const easel *e, int32_t x, int32_t y)
{
    return *(const float *)pixel(&e->depth, x, y);
}

const float *easel_colour(const easel *e, int32_t x, int32_t y)
{
    return pixel(&e->colour, x, y);
}

void easel_ray(const tyn_camera *c, int32_t width, int32_t height, int32_t x, int32_t y, double ray[2])
{
    ray[0] = (double)c->left_edge + (x + 0.5) / width * ((double)c->right_edge - (double)c->left_edge);
    ray[1] = (double)c->top_edge + (y + 0.5) / height * ((double)c->bottom_edge - (double)c->top_edge);
}

tyn_mesh easel_mesh(const float *positions, uint32_t triangles)
{
    static uint32_t count_up[EASEL_CORNERS];
    tyn_mesh mesh;
    memset(&mesh, 0, sizeof mesh);
    if (triangles > EASEL_CORNERS / 3)
        abort();
    for (uint32_t i = 0; i < EASEL_CORNERS; i++)
        count_up[i] = i;
    mesh.positions = positions;
    mesh.indices = count_up;
    mesh.triangles = triangles;
    mesh.vertices = 3 * triangles;
    for (int c = 0; c < 3; c++)
        mesh.material.albedo[c] = 0.5f;
    return mesh;
}

static void run(void *context, tyn_job job, void *argument, int32_t count)
{
    const easel_crew *crew = context;
    int32_t *turn = malloc((size_t)(count + 1) * sizeof *turn);
    if (!turn)
        abort();
    for (int32_t i = 0; i < count; i++)
        turn[i] = crew->order == EASEL_REVERSED ? count - 1 - i : i;
    for (int32_t i = count - 1; i > 0 && crew->order == EASEL_SHUFFLED; i--) {
        int32_t k = (int32_t)(test_random() % (uint32_t)(i + 1)), swap = turn[i];
        turn[i] = turn[k];
        turn[k] = swap;
    }
    for (int32_t i = crew->fault == 4 ? count : crew->fault == 1; i < count; i++)
        job(argument, turn[i],
            crew->fault == 3 && i == 0 ? crew->executor.workers : (int32_t)(test_random() % (uint32_t)crew->executor.workers));
    if (crew->fault == 2 && count)
        job(argument, turn[0], 0);
    free(turn);
}

void easel_hire(easel_crew *crew, easel_order order, int32_t workers)
{
    crew->executor.run = run;
    crew->executor.context = crew;
    crew->executor.workers = workers;
    crew->order = order;
    crew->fault = 0;
}

/* ---- an exact view of a triangle ------------------------------------------------------------------------------------ */

double easel_dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

void easel_cross(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

easel_exact easel_exact_new(double v[3][3])
{
    easel_exact t;
    double a[3], b[3];
    for (int k = 0; k < 3; k++) {
        a[k] = v[1][k] - v[0][k];
        b[k] = v[2][k] - v[0][k];
        easel_cross(v[k], v[(k + 1) % 3], t.edge[k]);
    }
    easel_cross(a, b, t.normal);
    t.distance = easel_dot(t.normal, v[0]);
    return t;
}

double easel_exact_hit(const easel_exact *t, const double r[3], const double step[2], double margin)
{
    double side[3], w;
    int unsure = 0;
    for (int k = 0; k < 3; k++) {
        double slope = hypot(t->edge[k][0] * step[0], t->edge[k][1] * step[1]);
        side[k] = easel_dot(t->edge[k], r) * (t->distance < 0 ? -1 : 1);
        if (fabs(side[k]) <= margin * slope)
            unsure = 1;
        else if (side[k] < 0)
            return 0;
    }
    if (unsure || t->distance == 0)
        return -1;
    w = t->distance / easel_dot(t->normal, r);
    return w > 0 ? w : 0;
}

tyn_shadow easel_plain_map(int32_t size)
{
    tyn_shadow s;
    memset(&s, 0, sizeof s);
    s.size = size;
    s.matrix[0] = s.matrix[5] = 1.0f / (float)size;
    s.matrix[10] = s.matrix[15] = 1.0f;
    return s;
}

void easel_set_corner(float *p, double x, double y, double z)
{
    p[0] = (float)x;
    p[1] = (float)y;
    p[2] = (float)z;
}

int64_t easel_count_set(const float *map, int32_t size)
{
    int64_t n = 0;
    for (int32_t i = 0; i < size * size; i++)
        n += map[i] > 0.0f;
    return n;
}

void easel_random_matrix(float m[16], int perspective)
{
    memset(m, 0, 16 * sizeof *m);
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 4; k++)
            m[4 * i + k] = test_random_float(-1, 1) * (k == 3 ? 0.5f : 0.2f) + (k == 3 ? 0.5f : 0.0f);
    m[15] = test_random_float(0.5f, 2.0f);
    if (!perspective)
        return;
    for (int k = 0; k < 3; k++) {
        m[12 + k] = test_random_float(-1, 1) * 0.5f;
        m[8 + k] = 0;
    }
    m[11] = 0.3f;
}
