/* chart.c - see chart.h */
#include "chart.h"

#include "base.h"
#include "composite.h"
#include "ray.h"
#include "trace.h"
#include "tree.h"

static const float lit_colour[3] = {0.55f, 0.4f, 0.08f};
static const float dark_colour[3] = {0.01f, 0.02f, 0.08f};
static const float white[3] = {1.0f, 1.0f, 1.0f};
static const float grey[3] = {0.12f, 0.12f, 0.12f};
static const float black[3] = {0.0f, 0.0f, 0.0f};
static const float green[3] = {0.05f, 0.8f, 0.05f};
static const float red[3] = {0.8f, 0.05f, 0.05f};
static const float slate[3] = {0.25f, 0.25f, 0.3f};

/* Where it is drawn: columns of the row over the width, positions over a band's height. */
typedef struct chart {
    const tyn_image *image;
    int32_t columns;
    int32_t top, height; /* of the band, in pixels */
} chart;

static void fill(const chart *c, int32_t x0, int32_t x1, int32_t y0, int32_t y1, const float rgb[3])
{
    static const tyn_display display = {1.0f, TYN_TONE_CLAMP, 0};
    float one[3];
    float *const pixel[3] = {&one[0], &one[1], &one[2]};
    memcpy(one, rgb, sizeof one);
    for (int32_t y = tyni_maxi(y0, c->top); y < tyni_mini(y1, c->top + c->height); y++)
        for (int32_t x = tyni_maxi(x0, 0); x < tyni_mini(x1, c->image->width); x++)
            tyni_composite_write(TYN_ISA_SCALAR, c->image, &display, x, y, 1, pixel);
}

static int32_t x_of(const chart *c, int32_t column)
{
    return (int32_t)((int64_t)column * c->image->width / c->columns);
}

static int32_t y_of(const chart *c, uint32_t position)
{
    return c->top + (int32_t)((int64_t)position * c->height / 65536);
}

/* Each column lit down to its threshold. */
static void draw_row(const chart *c, const tyni_row *row)
{
    fill(c, 0, c->image->width, c->top, c->top + c->height, dark_colour);
    for (int32_t i = 0; i < row->columns; i++) {
        int32_t x = x_of(c, i), end = tyni_maxi(x_of(c, i + 1), x + 1);
        fill(c, x, end, c->top, y_of(c, row->threshold[i]), lit_colour);
    }
    for (int32_t k = 1; k < row->count; k++) /* from one map to the next */
        fill(c, x_of(c, row->pieces[k].first), x_of(c, row->pieces[k].first) + 1, c->top, c->top + c->height, slate);
}

/* The columns first .. last that a ray crosses, of all pieces; it is bright where it gathers light. */
static void draw_ray(const chart *c, const tyni_row *row, uint32_t position, int32_t first, int32_t last)
{
    int32_t y = y_of(c, position);
    fill(c, 0, c->image->width, y, y + 1, slate);
    for (int32_t i = first; i <= last; i++)
        fill(c, x_of(c, i), tyni_maxi(x_of(c, i + 1), x_of(c, i) + 1), y - 1, y + 2,
             position < row->threshold[i] ? white : grey);
}

static void draw_node(const chart *c, const tyni_tree *tree, int32_t level, int32_t k, const float rgb[3])
{
    const tyni_node *node = tyni_tree_node(tree, level, k);
    int32_t x = x_of(c, k << level), end = x_of(c, tyni_mini((k + 1) << level, c->columns));
    int32_t y = y_of(c, node->low);
    fill(c, x, tyni_maxi(end - (end - x > 3), x + 1), y, tyni_maxi(y_of(c, node->high), y + 1), rgb);
}

/* A band for each level, the finest first. */
static void draw_tree(chart *c, const tyni_row *row, const tyni_tree *tree, uint32_t position, int32_t first, int32_t last,
                      int32_t top, int32_t height)
{
    int32_t bands = tree->levels - TYNI_TREE_FIRST + 1, level = 0, highest;
    int lit = 0;
    if (tree->levels < TYNI_TREE_FIRST)
        return;
    for (int32_t l = TYNI_TREE_FIRST; l <= tree->levels; l++) {
        c->top = top + (l - TYNI_TREE_FIRST) * height / bands + 1;
        c->height = tyni_maxi(height / bands - 2, 1);
        for (int32_t k = 0; k << l < row->columns; k++)
            draw_node(c, tree, l, k, slate);
    }
    for (int32_t i = first; i <= last; i += 1 << level) {
        tyni_tree_span(tree, row->threshold, position, i, &level, &highest, &lit);
        for (int32_t l = tyni_maxi(level, TYNI_TREE_FIRST); l <= highest; l++) {
            c->top = top + (l - TYNI_TREE_FIRST) * height / bands + 1;
            draw_node(c, tree, l, i >> l, l > level ? white : lit ? green : red);
            fill(c, x_of(c, i >> l << l), x_of(c, tyni_mini(((i >> l) + 1) << l, c->columns)), y_of(c, position),
                 y_of(c, position) + 1, white);
        }
    }
}

/* The ray of a sample in all pieces that it crosses. A function of its own, since its table takes stack that building a row
 * needs. */
static TYNI_NOINLINE void draw_rays(const tyni_pass *p, chart *c, const tyni_slice *slice, const tyni_scratch *s,
                                    const tyni_tree *tree, int32_t sample)
{
    static const int32_t channels[1] = {0};
    int32_t first, last, height = p->frame->target.height, upper = c->height;
    float at = tyni_slice_p(slice, sample), length, t0, t1, from, to;
    uint32_t position = tyni_row_position(s->row, at);
    tyni_sight v;
    tyni_integral it;
    length = tyni_slice_sight(slice, &p->view, at, &v);
    if (!tyni_pass_range(p, &v, s->depth[sample] * length, &t0, &t1))
        return;
    tyni_integral_begin(&it, &p->medium, p->lamp, &v, t0, t1, channels, 1);
    for (int32_t i = 0; i < s->row->count; i++) {
        const tyni_piece *piece = &s->row->pieces[i];
        if (!tyni_ray_columns(s->row, piece, &it, &v, &first, &last, &from, &to))
            continue;
        first += piece->first;
        last += piece->first;
        c->top = 0;
        c->height = upper;
        draw_ray(c, s->row, position, first, last);
        if (p->frame->debug == TYN_DEBUG_TREE)
            draw_tree(c, s->row, tree, position, first, last, upper, height - upper);
    }
}

void tyni_chart_draw(const tyni_pass *p)
{
    float x = p->frame->debug_x, y = p->frame->debug_y, distance;
    int32_t index, sample, height = p->frame->target.height;
    chart c = {&p->frame->target, 0, 0, 0};
    tyni_scratch s;
    tyni_slice slice;
    tyni_finder finder;
    tyni_tree tree;
    if (x == 0.0f && y == 0.0f) {
        x = 0.5f * (float)p->view.width;
        y = 0.5f * (float)height;
    }
    tyni_pass_scratch(p->context, 0, &s);
    if (!c.image->pixels || !tyni_pass_nearest(p, x, y, &index, &sample, &distance) ||
        !tyni_trace_row(p, index, &slice, &s, &finder, &tree) || !s.row->columns)
        return;
    c.columns = s.row->columns;
    c.height = height;
    fill(&c, 0, c.image->width, 0, height, black);
    c.height = p->frame->debug == TYN_DEBUG_TREE ? (height + 2) / 3 : height;
    draw_row(&c, s.row);
    draw_rays(p, &c, &slice, &s, &tree, tyni_clampi(sample, slice.first, slice.last));
}
