/* frame.h - all stages in order, as jobs. */
#ifndef TYNI_FRAME_H
#define TYNI_FRAME_H

#include "arena.h"
#include "pass.h"

#include "base.h"

/* Carves a context for a config with its defaults filled in; in an arena without a block it only counts. */
void tyni_frame_place(tyn_context *context, tyni_arena *arena);

/* All of tyn_render but for the checks. */
tyn_status tyni_frame_render(tyn_context *context, const tyn_frame *frame);

#endif
