/* main.c - the commands of the tool. */
#include "commands.h"
#include "error.h"

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "tyndall.h"

static const char help[] = "usage: tyndall COMMAND ...\n"
                           "\n"
                           "  render SCENE -o OUT [options]   render a scene file; see tyndall render --help\n"
                           "  post FRAME -o OUT [options]     add shafts to somebody else's frame; see tyndall post --help\n"
                           "  compare A.pfm B.pfm             relative L1, RMSE, PSNR, largest error of A; B is the truth\n"
                           "  bench [options]                 time the stages; see tyndall bench --help\n"
                           "  showcase [FOLDER [NAME ...]]    render the built-in scenes as PNGs\n"
                           "  info                            version, instruction sets, memory of each preset\n"
                           "  --help, --version\n"
                           "\n"
                           "Exit status: 0 complete, 1 bad input (message on stderr), 2 bad usage.\n";

static int run(int argc, char **argv)
{
    const char *command = argc > 1 ? argv[1] : "";
    if (argc < 2) {
        fputs(help, stderr);
        return 2;
    }
    if (strcmp(command, "--help") == 0 || strcmp(command, "-h") == 0 || strcmp(command, "help") == 0) {
        fputs(help, stdout);
        return 0;
    }
    if (strcmp(command, "--version") == 0) {
        printf("tyndall %s\n", tyn_version());
        return 0;
    }
    if (strcmp(command, "render") == 0)
        return command_render(argc - 2, argv + 2);
    if (strcmp(command, "post") == 0)
        return command_post(argc - 2, argv + 2);
    if (strcmp(command, "compare") == 0)
        return command_compare(argc - 2, argv + 2);
    if (strcmp(command, "info") == 0)
        return command_info(argc - 2, argv + 2);
    if (strcmp(command, "showcase") == 0)
        return command_showcase(argc - 2, argv + 2);
    if (strcmp(command, "bench") == 0)
        return command_bench(argc - 2, argv + 2);
    error_say("'%.500s': unknown command; see tyndall --help", command);
    return 2;
}

/* With a standard stream closed, the next file opened would get its number, and messages would go into a picture. What is put
 * there instead can't be written, so that lost output still counts as an error. */
static void hold_streams(void)
{
    for (int fd = 0; fd <= 2; fd++)
        if (fcntl(fd, F_GETFD) < 0 && open("/dev/null", O_RDONLY) != fd)
            exit(1);
}

int main(int argc, char **argv)
{
    int status;
    hold_streams();
    status = run(argc, argv);
    /* What was printed is output too: a full disk behind stdout is a failure. */
    if (fflush(stdout) != 0 || ferror(stdout)) {
        error_say("stdout: can't be written");
        return status ? status : 1;
    }
    return status;
}
