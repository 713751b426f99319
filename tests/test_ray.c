/* test_ray.c - the ways to find a ray's lit columns: the same switches, so the same bytes. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "line.h"
#include "meter.h"
#include "ray.h"
#include "rig.h"
#include "stock.h"
#include "sweep.h"
#include "test.h"
#include "tree.h"
#include "walk.h"

enum { STEPS = 700, COLUMNS = 2 * STEPS, SAMPLES = 400 };

/* A row made by hand, of a sun: steps are a metre, the ray starts at the camera and runs along the row. */
typedef struct bench {
    uint16_t threshold[COLUMNS + 64], edge[COLUMNS + 64]; /* finders read whole blocks */
    tyni_row row;
    tyni_slice slice;
    uint16_t low[COLUMNS / 64 + 33], high[COLUMNS / 64 + 33];
    tyni_blocks blocks;
    tyni_node nodes[COLUMNS / 2 + TYNI_TREE_LEVELS];
    tyni_tree tree;
    uint32_t order[COLUMNS], heads[SAMPLES + 1], bits[COLUMNS / 32 + 2];
    uint16_t position[SAMPLES];
    tyni_sweep sweep;
    tyni_medium medium;
    tyni_lamp lamp;
} bench;

/* Thresholds of several characters: noise, steps, slopes, all lit, all dark. */
static void fill(uint16_t *threshold, int count)
{
    int kind = (int)(test_random() % 6u), run = 1 + (int)(test_random() % 200u);
    uint16_t held = 0;
    for (int i = 0; i < count; i++) {
        if (kind == 0 || (kind == 1 && i % run == 0))
            held = (uint16_t)test_random();
        if (kind == 2)
            held = (uint16_t)(65535 * i / count);
        if (kind == 3 || (kind == 5 && i % run == 0))
            held = test_random() % 3u ? 65535 : 0;
        if (kind == 4)
            held = (uint16_t)(30000 + (int)(test_random() % 5u));
        threshold[i] = held;
    }
}

/* One piece, or two that share the row; falling: positions fall along the samples. */
static void set_up(bench *b, int pieces, int falling)
{
    int steps = 1 + (int)(test_random() % STEPS), first = pieces > 1 ? steps / 2 : steps;
    memset(b, 0, sizeof *b);
    fill(b->threshold, 2 * steps);
    b->row.threshold = b->threshold;
    b->row.edge = b->edge;
    b->row.columns = 2 * steps;
    for (int k = 0; k < pieces && (k == 0 || first < steps); k++) {
        tyni_piece *p = &b->row.pieces[b->row.count++];
        int from = k ? first : 0, count = k ? steps - first : first;
        if (count < 1) {
            b->row.count--;
            continue;
        }
        p->first = 2 * from;
        p->steps = count;
        p->unit = 1.0f / 64;
        for (int i = 0; i < count; i++) {
            int whole = test_random() % 3u != 0;
            b->edge[2 * (from + i)] = (uint16_t)(64 * i);
            b->edge[2 * (from + i) + 1] = (uint16_t)(64 * i + (whole ? 64 : (int)(test_random() % 65u)));
            if (whole)
                b->threshold[2 * (from + i) + 1] = b->threshold[2 * (from + i)];
        }
        p->to = (float)count;
        p->r.v.x = 1; /* the step coordinate is x, less where the piece begins */
        p->r.c = -(float)from;
        p->w.c = 1;
    }
    b->slice.first = (int)(test_random() % 5u);
    b->slice.last = b->slice.first + (int)(test_random() % (SAMPLES - 5));
    b->slice.p0 = 0.5f;
    b->slice.dp = 1;
    b->row.p_start = tyni_slice_p(&b->slice, falling ? b->slice.last : b->slice.first);
    b->row.p_scale = b->slice.last > b->slice.first ? 65534.0f / (float)(b->slice.last - b->slice.first) : 0;
    b->row.p_scale = falling ? -b->row.p_scale : b->row.p_scale;
    b->blocks.low = b->low;
    b->blocks.high = b->high;
    b->sweep.order = b->order;
    b->sweep.heads = b->heads;
    b->sweep.bits = b->bits;
    b->sweep.position = b->position;
    b->medium.sigma[0] = b->medium.sigma[2] = 0.01f;
    b->medium.sigma[1] = 0.03f;
    b->lamp.outside = (int)(test_random() & 1u);
    b->lamp.kind = TYN_LIGHT_DIRECTIONAL;
}

/* The march that everything is held against: each column in turn, nothing packed, nothing skipped. Every column is switched at
 * its border, whether it changes or not. */
static void untraversed(const bench *b, float p, const tyni_integral *it, const tyni_sight *v, float light[2])
{
    uint32_t position = tyni_row_position(&b->row, p);
    tyni_meter m;
    tyni_meter_begin(&m, it, &b->lamp, v, light);
    for (int i = 0; i < b->row.count; i++) {
        const tyni_piece *piece = &b->row.pieces[i];
        tyni_line r = tyni_line_along(&piece->r, v);
        int32_t first, last;
        float from, to;
        if (!tyni_ray_columns(&b->row, piece, it, v, &first, &last, &from, &to))
            continue;
        from = from > 0 ? from : 0;
        to = to < (float)piece->steps ? to : (float)piece->steps;
        for (int32_t c = first; c <= last; c++)
            tyni_meter_lit(&m, position < b->row.threshold[piece->first + c],
                           ((c == first ? from : tyni_row_edge(&b->row, piece, c)) - r.c) / r.d);
        tyni_meter_lit(&m, m.outside, (to - r.c) / r.d);
    }
    tyni_meter_end(&m);
}

/* The ray of a sample, which runs along the row at a slope of its own and starts before, in or behind it. */
static void random_ray(bench *b, tyni_sight *v, tyni_integral *it)
{
    static const int32_t channels[2] = {0, 1};
    float reach = test_random_float(1, (float)b->row.columns);
    memset(v, 0, sizeof *v);
    v->d.x = test_random_float(0.2f, 1);
    v->o.x = test_random() & 1u ? 0.0f : test_random_float(-20, (float)b->row.columns / 2);
    tyni_integral_begin(it, &b->medium, &b->lamp, v, 0, reach / v->d.x, channels, 2);
}

static void test_finders(void)
{
    static bench b;
    const int32_t isas = tyn_isa_available(); /* asks the processor, which is slow on virtual machines */
    TEST("tree, sweep, words and columns give the untraversed march's bytes");
    for (int n = 0; n < 1500; n++) {
        set_up(&b, 1 + (int)(test_random() & 1u), (int)(test_random() & 1u));
        tyni_row_bound(&b.blocks, TYN_ISA_SCALAR, &b.row);
        tyni_tree_build(&b.tree, b.nodes, &b.row);
        tyni_sweep_begin(&b.sweep, &b.row, &b.slice);
        for (int k = 0; k < 12; k++) {
            int sample = b.slice.first + (int)(test_random() % (uint32_t)(b.slice.last - b.slice.first + 1));
            float p = tyni_slice_p(&b.slice, sample), truth[2], light[2];
            tyni_finder f = {&b.row, TYN_ISA_SCALAR, TYN_RAYS_WORDS, &b.blocks, &b.tree, 0.05f, &b.sweep};
            tyni_integral it;
            tyni_sight v;
            random_ray(&b, &v, &it);
            untraversed(&b, p, &it, &v, truth);
            tyni_sweep_to(&b.sweep, sample); /* to and fro */
            for (int way = TYN_RAYS_WORDS; way <= TYN_RAYS_COLUMNS; way++) {
                f.rays = (tyn_rays)way;
                if (way == TYN_RAYS_STEPS)
                    continue;
                light[0] = light[1] = -1;
                for (f.isa = TYN_ISA_SCALAR; f.isa <= (way == TYN_RAYS_WORDS ? isas : 1); f.isa *= 2) {
                    if (!(f.isa & isas))
                        continue;
                    CHECK(tyni_ray_row(&f, p, &b.lamp, &it, &v, light) >= 0);
                    CHECK(memcmp(light, truth, sizeof light) == 0);
                    light[0] = light[1] = -1;
                }
            }
        }
    }
}

/* A node holds exactly its columns' least and greatest, on every level; levels go up to all of the row. */
static void test_tree_bounds(void)
{
    static bench b;
    TEST("the tree's bounds");
    for (int n = 0; n < 400; n++) {
        int bad = 0;
        size_t used = 0;
        set_up(&b, 1, 0);
        tyni_tree_build(&b.tree, b.nodes, &b.row);
        CHECK(b.row.columns < 4 ? b.tree.levels == 0 : b.row.columns >> b.tree.levels == 1);
        for (int level = TYNI_TREE_FIRST; level <= b.tree.levels; level++)
            for (int k = 0; k << level < b.row.columns; k++, used++) {
                const tyni_node *node = tyni_tree_node(&b.tree, level, k);
                uint16_t low = 65535, high = 0;
                for (int c = k << level; c < (k + 1) << level && c < b.row.columns; c++) {
                    low = b.threshold[c] < low ? b.threshold[c] : low;
                    high = b.threshold[c] > high ? b.threshold[c] : high;
                }
                bad += node->low != low || node->high != high;
            }
        CHECK(bad == 0 && used <= tyni_tree_room((size_t)b.row.columns));
    }
}

/* The sweep's bits are the compares', at every sample, forwards, backwards and anyhow. */
static void test_sweep_bits(void)
{
    static bench b;
    TEST("the sweep's words are the compares'");
    for (int n = 0; n < 300; n++) {
        int count, bad = 0;
        set_up(&b, 1, (int)(test_random() & 1u));
        tyni_sweep_begin(&b.sweep, &b.row, &b.slice);
        count = b.slice.last - b.slice.first + 1;
        for (int k = 0; k < 40; k++) {
            int sample = b.slice.first + (k < 10   ? k * count / 10
                                          : k < 20 ? (19 - k) * count / 10
                                                   : (int)(test_random() % (uint32_t)count));
            uint32_t position = tyni_row_position(&b.row, tyni_slice_p(&b.slice, sample));
            tyni_sweep_to(&b.sweep, sample);
            for (int c = 0; c < b.row.columns; c++)
                bad += (tyni_sweep_word(&b.sweep, c) & 1u) != (position < b.threshold[c]);
        }
        CHECK(bad == 0);
    }
}

/* Whole frames: every light, lines and coarse pictures as well. */
static void test_frames(void)
{
    enum { W = 64, H = 48, PIXELS = W * H };
    static float scatter[3 * PIXELS];
    static uint8_t target[4 * PIXELS];
    TEST("frames of every light are the same to the byte by words, tree, sweep and columns");
    for (int n = 0; n < stock_count; n++) {
        oracle_scene *scene = stock_new(stock_list[n].name, W, H);
        rig *r = rig_new(scene, 256);
        tyn_config config;
        CHECK(r != NULL);
        if (!r)
            return;
        config = rig_config(r, TYN_METHOD_EPIPOLAR, TYN_RAYS_WORDS);
        config.gather = (tyn_gather)(n % 3);
        config.downscale = 1 << n / 3 % 3;
        for (int way = TYN_RAYS_WORDS; way <= TYN_RAYS_COLUMNS; way++) {
            tyn_frame frame = rig_frame(r);
            config.rays = (tyn_rays)way;
            if (way == TYN_RAYS_STEPS)
                continue;
            CHECK(rig_render(r, &config, &frame) == TYN_OK);
            if (way == TYN_RAYS_WORDS) {
                memcpy(scatter, r->scatter, sizeof scatter);
                memcpy(target, r->target, sizeof target);
            }
            CHECK(memcmp(scatter, r->scatter, sizeof scatter) == 0 && memcmp(target, r->target, sizeof target) == 0);
        }
        rig_free(r);
        model_free(scene);
    }
}

/* Where the row is simple the tree looks at few nodes; it never looks at much more than there are columns. */
static void test_tree_work(void)
{
    static bench b;
    int64_t nodes = 0, columns = 0;
    TEST("the tree's work");
    for (int n = 0; n < 500; n++) {
        tyni_finder f = {&b.row, TYN_ISA_SCALAR, TYN_RAYS_TREE, &b.blocks, &b.tree, 0.05f, &b.sweep};
        tyni_integral it;
        tyni_sight v;
        float light[2];
        int32_t looked, all;
        set_up(&b, 1, 0);
        tyni_tree_build(&b.tree, b.nodes, &b.row);
        random_ray(&b, &v, &it);
        looked = tyni_ray_row(&f, tyni_slice_p(&b.slice, b.slice.first), &b.lamp, &it, &v, light);
        f.rays = TYN_RAYS_COLUMNS;
        all = tyni_ray_row(&f, tyni_slice_p(&b.slice, b.slice.first), &b.lamp, &it, &v, light);
        CHECK(looked <= all + all / 2 + 40); /* a climb and a descent for every four columns at most */
        nodes += looked;
        columns += all;
    }
    CHECK(nodes < columns / 2);
}

/* A bundle's rays where all are coarse: what an exact walk of each finds. */
static void test_coarse(void)
{
    static uint16_t threshold[2 * 6 * 260], edge[2 * 6 * 260];
    static float depth[64 + 16];
    static tyni_lamp lamp;
    static tyni_row row;
    static tyni_bundle bundle;
    tyni_finder f = {&row, 0, TYN_RAYS_COLUMNS, NULL, NULL, 0.0f, NULL};
    TEST("coarse rays of a bundle are exact walks");
    tyni_lanes_choose(0, &f.isa);
    for (int n = 0; n < stock_count; n++) {
        static const int32_t channels[3] = {0, 1, 2};
        const float sigma[2] = {0.02f, 0.3f};
        rig *r = rig_stock(stock_list[n].name, 64, 48, 256);
        tyni_medium medium;
        tyni_view view;
        tyni_slices slices;
        double sum = 0, most = 0;
        int rays = 0;
        tyni_view_camera(&view, &r->camera, 64, 48);
        tyni_view_lamp(&lamp, &r->light[0], &view);
        memset(&slices, 0, sizeof slices);
        memset(&medium, 0, sizeof medium);
        medium.sigma[0] = sigma[0];
        medium.sigma[1] = medium.sigma[2] = sigma[1];
        if (lamp.kind == TYN_LIGHT_DIRECTIONAL && !lamp.no_epipole && !tyni_view_coloured(&lamp))
            tyni_slice_layout(&slices, &lamp, 64, 48, 64, 1);
        for (int32_t i = 0; i < slices.count; i++) {
            tyni_slice slice;
            tyni_slice_line(&slice, &slices, &lamp, &view, i);
            for (int32_t j = slice.first; j <= slice.last; j++)
                depth[j] = test_random_float(0, view.far_depth);
            if (slice.first > slice.last)
                continue;
            tyni_row_build(&row, f.isa, threshold, edge, 6 * 260, &slice, &lamp, &view, 1e4f);
            memset(&bundle, 0, sizeof bundle);
            for (int32_t j = slice.first; j <= slice.last && bundle.count < TYNI_RAY_BUNDLE; j += 1 + (int)(test_random() % 4u))
                bundle.sample[bundle.count++] = (uint16_t)j;
            tyni_ray_bundle(&bundle, &f, &slice, &view, depth, 0.0f, &lamp, sigma);
            for (int32_t k = 0; k < bundle.count; k++, rays++) {
                tyni_sight v;
                tyni_integral it;
                float lit[3], all[3], length = tyni_slice_sight(&slice, &view, tyni_slice_p(&slice, bundle.sample[k]), &v);
                tyni_integral_begin(&it, &medium, &lamp, &v, 0.0f, depth[bundle.sample[k]] * length, channels, 2);
                tyni_walk_ray(TYN_ISA_SCALAR, &lamp, &it, &v, 1, lit);
                tyni_integral_at(&it, it.t1, all);
                for (int c = 0; c < 2; c++) {
                    double off = fabs((double)bundle.visible[c][k] - (double)lit[c] / (double)all[c]);
                    CHECK(bundle.visible[c][k] >= 0.0f && bundle.visible[c][k] <= 1.0f);
                    sum += off;
                    most = off > most ? off : most;
                }
            }
        }
        if (rays)
            printf("  %-22s %d rays, mean %.2e, most %.2e\n", stock_list[n].name, rays, sum / (2 * rays), most);
        CHECK(sum <= 1e-6 * 2 * rays && most < 1e-3);
        rig_free(r);
    }
}

void test_ray(void)
{
    test_coarse();
    test_finders();
    test_tree_bounds();
    test_sweep_bits();
    test_tree_work();
    test_frames();
}
