/* command_render.c - tyndall render: load, draw, write. */
#include "commands.h"
#include "foreign_write.h"
#include "parse.h"
#include "pictures.h"
#include "progress.h"

static int draw(const options *o, const scene *s, uint64_t load_ns, uint64_t start, tool_error *error)
{
    render_result result;
    pictures files;
    int status = -1;
    pool *threads = pool_create(o->threads ? o->threads : pool_default_workers());
    if (!threads)
        return error_memory(error);
    if (pictures_open(&files, o, error) == 0 && render_scene(s, o->input, &o->settings, threads, &result, error) == 0) {
        if (pictures_write(&files, o, &result, error) == 0 &&
            (!o->frame || foreign_write(&files.set, o->frame, s, &result, error) == 0))
            status = output_commit(&files.set, error);
        if (status == 0 && o->stats)
            pictures_stats(&result, load_ns, start);
        render_free(&result);
    }
    if (status != 0)
        output_abort(&files.set);
    pool_free(threads);
    return status;
}

int command_render(int argc, char **argv)
{
    options o;
    scene s;
    tool_error error;
    uint64_t start = clock_now(NULL);
    int status;
    if (options_parse(&o, OPTIONS_RENDER, argc, argv) != 0)
        return 2;
    if (o.help) {
        options_help(OPTIONS_RENDER);
        return 0;
    }
    o.settings.want_surface = o.surface || o.frame;
    o.settings.want_maps = o.frame != NULL;
    progress_stage("scene");
    status = scene_load(&s, o.input, &error);
    if (status == 0) {
        status = draw(&o, &s, clock_now(NULL) - start, start, &error);
        scene_free(&s);
    }
    progress_end();
    if (status != 0)
        error_report(&error, o.input);
    return status == 0 ? 0 : 1;
}
