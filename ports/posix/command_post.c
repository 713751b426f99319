/* command_post.c - tyndall post: read a frame, add shafts, write. */
#include "commands.h"
#include "pictures.h"
#include "post.h"
#include "progress.h"

static int draw(const options *o, foreign *f, uint64_t load_ns, uint64_t start, tool_error *error)
{
    render_result result;
    pictures files;
    int status = -1;
    pool *threads = pool_create(o->threads ? o->threads : pool_default_workers());
    if (!threads)
        return error_memory(error);
    if (pictures_open(&files, o, error) == 0 && post_frame(f, o->input, &o->settings, threads, &result, error) == 0) {
        if (pictures_write(&files, o, &result, error) == 0)
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

int command_post(int argc, char **argv)
{
    options o;
    foreign f;
    tool_error error;
    uint64_t start = clock_now(NULL);
    int status;
    if (options_parse(&o, OPTIONS_POST, argc, argv) != 0)
        return 2;
    if (o.help) {
        options_help(OPTIONS_POST);
        return 0;
    }
    progress_stage("frame");
    status = foreign_load(&f, o.input, &error);
    if (status == 0) {
        status = draw(&o, &f, clock_now(NULL) - start, start, &error);
        foreign_free(&f);
    }
    progress_end();
    if (status != 0)
        error_report(&error, o.input);
    return status == 0 ? 0 : 1;
}
