/* pass.c - one drawing of all meshes: clear, then batch after batch through set-up and fill. See raster.h. */
#include "raster/raster.h"

#include "jobs.h"

static int32_t bands(const tyni_raster_pass *pass)
{
    return (pass->view.height + TYNI_RASTER_BAND - 1) / TYNI_RASTER_BAND;
}

static void clear(void *argument, int32_t band, int32_t worker)
{
    const tyni_raster_pass *pass = argument;
    const int32_t first = band * TYNI_RASTER_BAND, end = tyni_mini(first + TYNI_RASTER_BAND, pass->view.height);
    (void)worker;
    for (int32_t y = first; y < end; y++) {
        float *depth = (float *)(void *)(pass->depth + y * pass->depth_stride);
        for (int32_t x = 0; x < pass->view.width; x++)
            depth[x] = pass->clear;
        if (pass->kind == TYNI_RASTER_SEEN) /* all ones are TYNI_RASTER_NOTHING; triangle numbers may be anything there */
            for (int32_t x = 0; x < pass->view.width; x += TYNI_RASTER_BLOCK)
                memset(pass->colour + y * pass->colour_stride + tyni_raster_mark_at(x), 0xff,
                       (size_t)tyni_raster_mark_step(x, pass->view.width));
    }
}

/* Hands the next triangles out to chunks, from *mesh and *triangle on. */
static void deal(tyni_raster_pass *pass, uint32_t *mesh, uint32_t *triangle)
{
    const tyn_raster *raster = pass->raster;
    int32_t room = raster->batch;
    pass->chunks = 0;
    while (room > 0 && *mesh < pass->mesh_count) {
        tyni_raster_chunk *chunk = &raster->chunks[pass->chunks];
        int32_t wanted = tyni_mini(room, TYNI_RASTER_CHUNK);
        chunk->mesh = *mesh;
        chunk->triangle = *triangle;
        chunk->count = 0;
        while (wanted > 0 && *mesh < pass->mesh_count) {
            const uint32_t left = pass->meshes[*mesh].triangles - *triangle;
            const int32_t taken = left < (uint32_t)wanted ? (int32_t)left : wanted;
            chunk->count += taken;
            wanted -= taken;
            *triangle += (uint32_t)taken;
            if (*triangle == pass->meshes[*mesh].triangles) {
                ++*mesh;
                *triangle = 0;
            }
        }
        room -= chunk->count;
        pass->triangles += chunk->count;
        if (chunk->count)
            pass->chunks++;
    }
}

tyn_status tyni_raster_run(tyni_raster_pass *pass)
{
    uint32_t mesh = 0, triangle = 0;
    tyn_status status;
    pass->triangles = 0;
    pass->bad = 0;
    pass->chunks = 0;
    memset(pass->raster->tallies, 0, (size_t)pass->raster->workers * sizeof *pass->raster->tallies);
    status = tyni_jobs_run(&pass->jobs, clear, pass, bands(pass));
    while (status == TYN_OK && mesh < pass->mesh_count) {
        deal(pass, &mesh, &triangle);
        status = tyni_jobs_run(&pass->jobs, tyni_raster_setup, pass, pass->chunks);
        for (int32_t i = 0; i < pass->chunks && status == TYN_OK; i++)
            pass->bad += pass->raster->chunks[i].bad;
        if (status == TYN_OK)
            status = tyni_jobs_run(&pass->jobs, tyni_raster_fill, pass, bands(pass));
    }
    return status;
}
