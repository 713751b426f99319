/* view.c - a camera or a shadow map as the view that triangles are set up for. See raster.h. */
#include "raster/raster.h"

#include "check.h"
#include "raster/pair.h"
#include "vec.h"

static void set_row(tyni_raster_view *view, int32_t i, const float *row, float shift)
{
    for (int32_t c = 0; c < 3; c++)
        view->row[i][c] = row[c];
    view->shift[i] = shift;
}

/* Offsets are taken from the image's centre: there a symmetric camera's rays are exact, and so is the horizon of a level one.
 */
static void set_window(tyni_raster_view *view, int32_t axis, float from, float to, int32_t size)
{
    const float n = (float)size;
    const tyni_pair span = tyni_pair_sum(to, -from), middle = tyni_pair_sum(0.5f * from, 0.5f * to);
    const float step = span.high / n;
    const tyni_pair back = tyni_pair_product(step, n);
    view->middle[axis] = middle.high;
    view->middle_low[axis] = middle.low;
    view->half[axis] = 0.5f * n;
    view->scale[axis] = n / span.high;
    view->step[axis] = step;
    view->step_low[axis] = ((span.high - back.high) - back.low + span.low) / n;
}

void tyni_raster_view_camera(tyni_raster_view *view, const tyn_camera *camera, int32_t width, int32_t height)
{
    static const float zero[3] = {0.0f, 0.0f, 0.0f};
    for (int32_t c = 0; c < 3; c++)
        view->origin[c] = camera->position[c];
    set_row(view, 0, camera->right, 0.0f);
    set_row(view, 1, camera->up, 0.0f);
    set_row(view, 2, zero, 1.0f);
    set_row(view, 3, camera->forward, 0.0f);
    set_window(view, 0, camera->left_edge, camera->right_edge, width);
    set_window(view, 1, camera->top_edge, camera->bottom_edge, height);
    /* Pixels decide on the near plane; the cut before it only keeps w off zero. */
    view->clip = 0.5f * camera->near_depth;
    view->width = width;
    view->height = height;
}

/* Where w gets too small: at a thousandth of the distance where z is 1, which is the map's near end. */
static float least_w(const float m[16])
{
    const tyni_vec3 z = tyni_vec_load(m + 8), w = tyni_vec_load(m + 12);
    const float square = tyni_vec_dot(w, w);
    float fall, nearest;
    if (!(square > 0.0f)) /* parallel: w is m[15] everywhere */
        return 0.5f * m[15];
    fall = tyni_vec_dot(z, w) / square; /* along the axis Z = fall W + rest */
    nearest = (m[11] - fall * m[15]) / (1.0f - fall);
    if (nearest > 0.0f && tyni_finite(nearest))
        return 1e-3f * nearest;
    return 1e-6f * sqrtf(square);
}

void tyni_raster_view_shadow(tyni_raster_view *view, const tyn_shadow *shadow)
{
    const float *m = shadow->matrix;
    for (int32_t c = 0; c < 3; c++)
        view->origin[c] = 0.0f;
    for (int32_t i = 0; i < 4; i++)
        set_row(view, i, m + 4 * i, m[4 * i + 3]);
    set_window(view, 0, 0.0f, 1.0f, shadow->size);
    set_window(view, 1, 0.0f, 1.0f, tyni_shadow_height(shadow));
    view->clip = tyni_maxf(least_w(m), 1e-30f);
    view->width = shadow->size;
    view->height = tyni_shadow_height(shadow);
}
