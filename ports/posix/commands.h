/* commands.h - one function per command of the tool. argv starts after the command's name; the result is the exit status:
 * 0 complete, 1 bad input or a failed write, 2 bad usage. */
#ifndef TOOL_COMMANDS_H
#define TOOL_COMMANDS_H

int command_render(int argc, char **argv);
int command_post(int argc, char **argv);
int command_compare(int argc, char **argv);
int command_info(int argc, char **argv);
int command_bench(int argc, char **argv);
int command_showcase(int argc, char **argv);

#endif
