/* query.c - scattered light and transmittance at points in the air: for what is not in the depth buffer. Each point has an
 * exact ray of its own, so no slices, no scratch and no context are needed. */
#include "tyndall.h"

#include "base.h"
#include "art.h"
#include "check.h"
#include "jobs.h"
#include "lanes/lanes.h"
#include "medium.h"
#include "num.h"
#include "slide.h"
#include "view.h"
#include "walk.h"

#define BATCH 64 /* points a job */

/* What jobs share. Nothing counts the jobs but the results: each batch begins with a transmittance that is none. */
#define WAITING (-1.0f)
#define TWICE (-2.0f)

typedef struct pass {
    const tyn_frame *frame;
    const tyn_query_point *points;
    tyn_query_result *results;
    int32_t count, isa;
    tyni_view view;
    tyni_medium medium;
    float fog[3];
} pass;

/* The ray to a point, and how far the medium reaches along it; 0: the camera itself, or no point at all. */
static TYNI_NOINLINE float ray_of(const pass *p, const tyn_query_point *point, tyni_sight *v)
{
    float length = tyni_view_sight(&p->view, point->x, point->y, v);
    if (!tyni_finite(point->x) || !tyni_finite(point->y) || !tyni_finite(length) || !tyni_vec_finite(v->o))
        return 0.0f;
    return tyni_art_reach(p->frame, tyni_view_depth(&p->view, point->depth) * length);
}

/* The frame's light i at the points of a batch, added up. */
static void add_light(const pass *p, const tyn_light *light, int32_t first, int32_t end)
{
    tyni_lamp lamp;
    if (!p->medium.scatters || light->scale < 0.0f)
        return;
    tyni_view_lamp(&lamp, light, &p->view);
    tyni_art_lamp(&lamp, light, p->frame);
    for (int32_t i = first; i < end; i++) {
        tyni_sight v;
        float s = ray_of(p, &p->points[i], &v), rgb[3];
        if (!(s > 0.0f))
            continue;
        tyni_walk_pixel(p->isa, &lamp, &p->medium, &v, s, 1, rgb);
        for (int32_t c = 0; c < 3; c++)
            p->results[i].scatter[c] += rgb[c];
    }
}

/* Apart from the jobs: what only this needs is off the stack when rays are walked. */
static TYNI_NOINLINE void begin_points(const pass *p, int32_t first, int32_t end)
{
    for (int32_t i = first; i < end; i++) {
        tyni_sight v;
        float s = ray_of(p, &p->points[i], &v);
        for (int32_t c = 0; c < 3; c++) {
            p->results[i].scatter[c] = 0.0f;
            p->results[i].transmittance[c] = tyni_num_exp(-p->fog[c] * s);
        }
    }
}

static void points_job(void *argument, int32_t index, int32_t worker)
{
    const pass *p = argument;
    int32_t first = index * BATCH, end = first + tyni_mini(BATCH, p->count - first);
    (void)worker;
    if (p->results[first].transmittance[0] != WAITING) {
        p->results[first].transmittance[0] = TWICE;
        return;
    }
    begin_points(p, first, end);
    for (int32_t i = 0; i < p->frame->light_count; i++)
        add_light(p, &p->frame->lights[i], first, end);
}

static TYNI_NOINLINE tyn_status check(const tyn_frame *f, const tyn_query_point *points, const tyn_query_result *results,
                                      int32_t count)
{
    tyn_status status = TYN_OK;
    if (!f || (count > 0 && (!points || !results)))
        return TYN_E_NULL;
    if (count < 0 || f->light_count > TYN_MAX_LIGHTS)
        return TYN_E_LIMIT;
    if ((uintptr_t)points % sizeof(float) || (uintptr_t)results % sizeof(float))
        return TYN_E_ALIGN;
    if (f->depth.width < 1 || f->depth.height < 1 || f->depth.width > TYN_MAX_SIZE || f->depth.height > TYN_MAX_SIZE)
        return TYN_E_IMAGE;
    status = tyni_check_camera(&f->camera);
    if (status == TYN_OK)
        status = tyni_check_lights(f->lights, f->light_count, TYN_MAX_SHADOW, TYN_MAX_MAPS);
    if (status == TYN_OK)
        status = tyni_slide_lights(f->lights, f->light_count, 1);
    if (status == TYN_OK)
        status = tyni_check_media(f->media, f->medium_count);
    if (status == TYN_OK)
        status = tyni_art_check(f);
    if (status == TYN_OK)
        status = tyni_jobs_check(f->executor, TYN_MAX_WORKERS);
    return status;
}

tyn_status tyn_query(const tyn_frame *frame, const tyn_query_point *points, tyn_query_result *results, int32_t count)
{
    tyni_jobs jobs = {NULL, NULL, 1};
    tyn_status status = check(frame, points, results, count);
    pass p;
    if (status == TYN_OK)
        status = tyni_lanes_choose(0, &p.isa);
    if (status != TYN_OK)
        return status;
    jobs.executor = frame->executor;
    jobs.workers = frame->executor ? frame->executor->workers : 1;
    p.frame = frame;
    p.points = points;
    p.results = results;
    p.count = count;
    tyni_view_camera(&p.view, &frame->camera, frame->depth.width, frame->depth.height);
    tyni_medium_prepare(&p.medium, frame->media, frame->medium_count);
    tyni_art_fog(p.fog, p.medium.sigma, frame);
    for (int32_t i = 0; i < count; i += tyni_mini(BATCH, count - i))
        results[i].transmittance[0] = WAITING;
    status = tyni_jobs_run(&jobs, points_job, &p, count / BATCH + (count % BATCH > 0));
    for (int32_t i = 0; i < count; i += tyni_mini(BATCH, count - i))
        if (results[i].transmittance[0] < 0.0f)
            status = TYN_E_EXECUTOR;
    return status;
}
