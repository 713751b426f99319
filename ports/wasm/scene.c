/* scene.c - see scene.h */
#include "scene.h"

#include <math.h>
#include <string.h>

#include "noise.h"

#define TEXELS 256 /* a side of each texture */
#define FIELD 72   /* cells of the ground, a side */
#define REACH 120.0f
#define TREES 7

static const uint32_t room[SCENE_MESHES] = {2 * FIELD * FIELD, 12000, 5000, 32000}; /* triangles at most */

/* What is being built: a mesh, where its parts lie in the world, and dice. */
typedef struct mason {
    scene *s;
    int mesh;
    float origin[3], sine, cosine; /* turned about +Y */
    float lean;                    /* x gains this much a metre of height */
    uint32_t dice;
} mason;

void scene_turn(float degrees, float *sine, float *cosine)
{
    float quarters = floorf(degrees * (1.0f / 90.0f) + 0.5f), x = (degrees - 90 * quarters) * 0.01745329252f, y = x * x;
    float s = x * (1 - y * (1.0f / 6) * (1 - y * (1.0f / 20) * (1 - y * (1.0f / 42) * (1 - y * (1.0f / 72)))));
    float c = 1 - y * 0.5f * (1 - y * (1.0f / 12) * (1 - y * (1.0f / 30) * (1 - y * (1.0f / 56))));
    int32_t quadrant = (int32_t)quarters & 3;
    *sine = quadrant == 0 ? s : quadrant == 1 ? c : quadrant == 2 ? -s : -c;
    *cosine = quadrant == 0 ? c : quadrant == 1 ? -s : quadrant == 2 ? -c : s;
}

static float smooth(float low, float high, float x)
{
    float t = (x - low) / (high - low);
    t = t < 0 ? 0 : t > 1 ? 1 : t;
    return t * t * (3 - 2 * t);
}

/* Level where the stones stand, hills around. */
static float height(float x, float z)
{
    float r = sqrtf(x * x + z * z), away = smooth(22, 110, r);
    return 0.25f * noise_sum(x * 0.09f, z * 0.09f, 3, 0, 11) + away * (5 + 9 * noise_sum(x * 0.013f, z * 0.013f, 3, 0, 12));
}

/* ---- triangles ----------------------------------------------------------------------------------------------------- */

static void add(mason *m, const float *a, const float *b, const float *c, const float uv[3][2])
{
    tyn_mesh *mesh = &m->s->meshes[m->mesh];
    const float *corner[3] = {a, b, c};
    if (mesh->triangles == room[m->mesh])
        return;
    for (int i = 0; i < 3; i++) {
        memcpy((float *)mesh->positions + 3 * mesh->vertices, corner[i], 3 * sizeof(float));
        memcpy((float *)mesh->texcoords + 2 * mesh->vertices, uv[i], 2 * sizeof(float));
        ((uint32_t *)mesh->indices)[mesh->vertices] = mesh->vertices;
        mesh->vertices++;
    }
    mesh->triangles++;
}

/* Four corners in a row; texture coordinates from the place. */
static void quad(mason *m, float p[4][3])
{
    float uv[4][2];
    for (int i = 0; i < 4; i++) {
        uv[i][0] = (p[i][0] + 0.7f * p[i][2]) * 0.21f;
        uv[i][1] = (m->mesh == SCENE_GROUND ? p[i][2] : p[i][1] + 0.4f * p[i][2]) * 0.21f;
    }
    const float second[3][2] = {{uv[0][0], uv[0][1]}, {uv[2][0], uv[2][1]}, {uv[3][0], uv[3][1]}};
    add(m, p[0], p[1], p[2], (const float(*)[2])uv);
    add(m, p[0], p[2], p[3], second);
}

static void place(mason *m, float x, float y, float z, float degrees)
{
    m->origin[0] = x;
    m->origin[1] = y;
    m->origin[2] = z;
    m->lean = 0;
    scene_turn(degrees, &m->sine, &m->cosine);
}

/* ---- stones -------------------------------------------------------------------------------------------------------- */

/* A point of a weathered block, its unit cube's (x, y, z) in -1 .. 1, y 0 .. 1. */
static void weather(const mason *m, const float half[3], const float cube[3], float out[3])
{
    float p[3], round = 1 - 0.1f * (cube[0] * cube[0] * cube[2] * cube[2]), top = smooth(0.8f, 1, cube[1]);
    for (int i = 0; i < 3; i++)
        p[i] = cube[i] * half[i] * (i == 1 ? 1 : round * (1 - 0.12f * cube[1] - 0.07f * top));
    p[1] -= 0.16f * top * (cube[0] * cube[0] + cube[2] * cube[2]);
    p[0] += m->lean * p[1];
    out[0] = m->origin[0] + m->cosine * p[0] + m->sine * p[2];
    out[1] = m->origin[1] + p[1];
    out[2] = m->origin[2] - m->sine * p[0] + m->cosine * p[2];
    for (int i = 0; i < 3; i++)
        p[i] = 0.17f * noise_sum(out[0] * 0.75f + 17.0f * (float)i, out[1] * 0.6f + 0.9f * out[2], 2, 0, 21 + (uint32_t)i);
    for (int i = 0; i < 3; i++)
        out[i] += p[i];
}

/* One face of a block in cells, from (-1, -1) to (1, 1) along two of its axes. */
static void face(mason *m, const float half[3], int across, int along, float side, int columns, int rows)
{
    int through = 3 - across - along;
    for (int row = 0; row < rows; row++)
        for (int column = 0; column < columns; column++) {
            float p[4][3];
            for (int i = 0; i < 4; i++) {
                float cube[3];
                cube[across] = 2 * (float)(column + (i == 1 || i == 2)) / (float)columns - 1;
                cube[along] = 2 * (float)(row + i / 2) / (float)rows - 1;
                cube[through] = side;
                cube[1] = 0.5f + 0.5f * cube[1];
                weather(m, half, cube, p[i]);
            }
            quad(m, p);
        }
}

static void block(mason *m, float width, float tall, float thick)
{
    const float half[3] = {0.5f * width, tall, 0.5f * thick};
    int rows = (int)(tall * 0.9f) + 1, columns = (int)(width * 1.1f) + 2;
    for (int side = -1; side <= 1; side += 2) {
        face(m, half, 0, 1, (float)side, columns, rows);
        face(m, half, 2, 1, (float)side, 2, rows);
        face(m, half, 0, 2, (float)side, columns, 2);
    }
}

static void build_stones(mason *m)
{
    enum { RING = 24 };
    const float step = 360.0f / RING, gap = 2 * 14.5f * 0.1305262f; /* of neighbours' middles: 2 r sin(step / 2) */
    static const float least[3] = {1.9f, 5.2f, 1.0f}, most[3] = {2.3f, 5.5f, 1.3f};
    float s, c, size[3];
    m->mesh = SCENE_STONE;
    for (int k = 0; k < RING; k++) {
        int fallen = k == 5 || k == 16, lost = k == 11, gate = k % 8 == 4 || k % 12 == 9;
        float at = step * (float)k;
        scene_turn(at, &s, &c);
        if (lost)
            continue;
        if (fallen) {
            place(m, 16.5f * s, height(16.5f * s, 16.5f * c) - 0.3f, 16.5f * c, at + 70);
            block(m, 4.6f, 1.2f, 1.9f);
            continue;
        }
        place(m, 14.5f * s, -0.5f, 14.5f * c, at + noise_next(&m->dice, -5, 5));
        m->lean = noise_next(&m->dice, -0.03f, 0.03f);
        for (int i = 0; i < 3; i++)
            size[i] = noise_next(&m->dice, least[i], most[i]);
        block(m, size[0], size[1], size[2]);
        if (gate || k == 4 || k == 10 || k == 15) /* the lintel from here to the next */
            continue;
        scene_turn(at + 0.5f * step, &s, &c);
        place(m, 14.4f * s, 4.75f, 14.4f * c, at + 0.5f * step + noise_next(&m->dice, -1.5f, 1.5f));
        block(m, gap + 0.25f, 0.85f, 1.15f);
    }
    for (int k = 0; k < 5; k++) { /* the horseshoe, highest at its back */
        float at = 180 + 62 * (float)(k - 2), tall = k == 2 ? 8.2f : k % 2 ? 7.2f : 6.4f;
        scene_turn(at, &s, &c);
        for (int leg = -1; leg <= 1; leg += 2) {
            place(m, 6.8f * s + 1.45f * (float)leg * c, -0.5f, 6.8f * c - 1.45f * (float)leg * s, at + 2 * (float)leg);
            block(m, 1.9f, tall, 1.25f);
        }
        if (k == 3)
            continue;
        place(m, 6.8f * s, tall - 0.75f, 6.8f * c, at + 1.5f);
        block(m, 5.0f, 1.0f, 1.35f);
    }
}

/* ---- trees --------------------------------------------------------------------------------------------------------- */

static void tube(mason *m, const float a[3], const float b[3], float ra, float rb)
{
    enum { SIDES = 6 };
    for (int i = 0; i < SIDES; i++) {
        float p[4][3];
        for (int k = 0; k < 4; k++) {
            float s, c, r = k < 2 ? ra : rb;
            const float *end = k < 2 ? a : b;
            scene_turn(360.0f / SIDES * (float)(i + (k == 1 || k == 2)), &s, &c);
            p[k][0] = end[0] + r * c;
            p[k][1] = end[1];
            p[k][2] = end[2] + r * s;
        }
        m->mesh = SCENE_BARK;
        quad(m, p);
    }
}

/* A tuft of leaves, each of two crossed directions: leaves are seldom square. */
static void leaves(mason *m, const float at[3], float reach, int count)
{
    m->mesh = SCENE_LEAF;
    for (int n = 0; n < count; n++) {
        float p[4][3], size = noise_next(&m->dice, 0.05f, 0.13f);
        for (int i = 0; i < 3; i++) {
            float middle = at[i] + reach * (i == 1 ? 0.7f : 1) * noise_next(&m->dice, -1, 1);
            middle += reach * (i == 1 ? 0.7f : 1) * noise_next(&m->dice, -1, 1);
            float e = noise_next(&m->dice, -1.4f, 1.4f) * size, f = noise_next(&m->dice, -1.4f, 1.4f) * size;
            p[0][i] = middle - e - f;
            p[1][i] = middle + e - f;
            p[2][i] = middle + e + f;
            p[3][i] = middle - e + f;
        }
        quad(m, p);
    }
}

static void tree(mason *m, float x, float z, float tall)
{
    const float foot[3] = {x, height(x, z) - 0.3f, z};
    const float fork[3] = {x + noise_next(&m->dice, -0.6f, 0.6f), foot[1] + 0.42f * tall,
                           z + noise_next(&m->dice, -0.6f, 0.6f)};
    tube(m, foot, fork, 0.045f * tall, 0.03f * tall);
    for (int k = 0; k < 9; k++) {
        float s, c, out = tall * noise_next(&m->dice, 0.16f, 0.34f), up = tall * noise_next(&m->dice, 0.14f, 0.5f);
        scene_turn(40.0f * (float)k + noise_next(&m->dice, -15, 15), &s, &c);
        const float tip[3] = {fork[0] + out * c, fork[1] + up, fork[2] + out * s};
        const float knee[3] = {fork[0] + 0.6f * out * c, fork[1] + 0.45f * up, fork[2] + 0.6f * out * s};
        tube(m, fork, knee, 0.018f * tall, 0.012f * tall);
        tube(m, knee, tip, 0.012f * tall, 0.004f * tall);
        leaves(m, tip, 0.095f * tall, 140);
        leaves(m, knee, 0.08f * tall, 60);
    }
}

static void build_trees(mason *m)
{
    static const float at[TREES][3] = {{-37, 16, 11.5f}, {38, 12, 10}, {14, -39, 13}, {-40, -21, 12},
                                       {37, -27, 13},    {-9, 42, 12}, {-52, 6, 13}};
    for (int i = 0; i < TREES; i++)
        tree(m, at[i][0], at[i][1], at[i][2]);
}

static void build_ground(mason *m)
{
    m->mesh = SCENE_GROUND;
    for (int row = 0; row < FIELD; row++)
        for (int column = 0; column < FIELD; column++) {
            float p[4][3];
            for (int i = 0; i < 4; i++) { /* finer in the middle */
                float u = 2 * (float)(column + (i == 1 || i == 2)) / FIELD - 1, v = 2 * (float)(row + i / 2) / FIELD - 1;
                p[i][0] = REACH * u * (0.3f + 0.7f * u * u);
                p[i][2] = REACH * v * (0.3f + 0.7f * v * v);
                p[i][1] = height(p[i][0], p[i][2]);
            }
            quad(m, p);
        }
}

/* ---- textures and all of it ---------------------------------------------------------------------------------------- */

static void paint(tyn_image *image, int mesh)
{
    static const float dark[SCENE_MESHES][3] = {
        {0.05f, 0.075f, 0.02f}, {0.2f, 0.19f, 0.17f}, {0.05f, 0.04f, 0.03f}, {0.05f, 0.1f, 0.02f}};
    static const float light[SCENE_MESHES][3] = {
        {0.19f, 0.21f, 0.07f}, {0.55f, 0.52f, 0.46f}, {0.2f, 0.16f, 0.12f}, {0.26f, 0.3f, 0.06f}};
    for (int y = 0; y < TEXELS; y++)
        for (int x = 0; x < TEXELS; x++) {
            float u = (float)x / TEXELS, v = (float)y / TEXELS;
            float t = 0.5f + 0.45f * noise_sum(u * 4, v * 4, 3, 4, 31) + 0.55f * noise_sum(u * 32, v * 32, 2, 32, 32);
            uint8_t *texel = (uint8_t *)image->pixels + 3 * (y * TEXELS + x);
            t = t < 0 ? 0 : t > 1 ? 1 : t;
            for (int i = 0; i < 3; i++)
                texel[i] = (uint8_t)(255 * (dark[mesh][i] + t * (light[mesh][i] - dark[mesh][i])) + 0.5f);
        }
}

static void bounds(scene *s)
{
    for (int i = 0; i < 3; i++) {
        s->low[i] = 1e6f;
        s->high[i] = -1e6f;
    }
    for (int k = SCENE_CASTERS; k < SCENE_MESHES; k++)
        for (uint32_t v = 0; v < 3 * s->meshes[k].vertices; v++) {
            float x = s->meshes[k].positions[v];
            s->low[v % 3] = x < s->low[v % 3] ? x : s->low[v % 3];
            s->high[v % 3] = x > s->high[v % 3] ? x : s->high[v % 3];
        }
}

size_t scene_bytes(void)
{
    size_t bytes = 16;
    for (int k = 0; k < SCENE_MESHES; k++)
        bytes += room[k] * (size_t)72 + (size_t)TEXELS * TEXELS * 3; /* a corner: five floats and its index */
    return bytes;
}

void scene_build(scene *s, void *memory)
{
    mason m = {.s = s, .dice = 5};
    float *next = (float *)(((uintptr_t)memory + 15) / 16 * 16);
    memset(s, 0, sizeof *s);
    for (int k = 0; k < SCENE_MESHES; k++) {
        tyn_mesh *mesh = &s->meshes[k];
        mesh->positions = next;
        mesh->texcoords = next + 9 * (size_t)room[k];
        mesh->indices = (const uint32_t *)(const void *)(next + 15 * (size_t)room[k]);
        next += 18 * (size_t)room[k];
        for (int i = 0; i < 3; i++)
            mesh->material.albedo[i] = 1;
        mesh->material.texture = &s->textures[k];
    }
    for (int k = 0; k < SCENE_MESHES; k++) {
        s->textures[k] = (tyn_image){(uint8_t *)next + (size_t)k * TEXELS * TEXELS * 3, TEXELS, TEXELS, 0, TYN_RGB8_LINEAR};
        paint(&s->textures[k], k);
    }
    build_ground(&m);
    build_stones(&m);
    build_trees(&m);
    bounds(s);
}
