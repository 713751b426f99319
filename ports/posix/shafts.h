/* shafts.h - the step that scenes and other people's frames share: from surfaces and their depth to the picture. */
#ifndef TOOL_SHAFTS_H
#define TOOL_SHAFTS_H

#include "render.h"

/* malloc aligned to TYN_ALIGNMENT; *block is to be freed. NULL without memory. */
void *shafts_aligned(size_t bytes, void **block);

/* What the settings ask for, in an image of this size. lights, maps, textured and workers are left to the caller. */
tyn_status shafts_config(tyn_config *config, const render_settings *settings, int32_t width, int32_t height);

/* Bytes from row to row of a shadow map that is made here; see tyn_shadow.stride. */
ptrdiff_t shafts_map_stride(int32_t size);

/* What the light is, but for its shadow maps. */
tyn_light shafts_light(const scene_light *from);

/* The rasterizer for images of the config's size and maps of its shadow_size; `block` is to be freed. -1: error set. */
int shafts_raster(tyn_raster **raster, const tyn_config *config, void **block, size_t *bytes, const char *name,
                  tool_error *error);

/* Room for what shafts_draw writes into *result: radiance, and scatter and debug where wanted. -1: error set; render_free it.
 */
int shafts_allocate(render_result *result, const tyn_config *config, const render_settings *settings, tool_error *error);

/* Fills result's radiance, scatter, debug, exposure and stats. The frame has camera, depth, colour, lights, media and art; the
 * rest is set here. -1: error set. */
int shafts_draw(const tyn_config *config, tyn_frame *frame, const render_settings *settings, pool *threads,
                render_result *result, const char *name, tool_error *error);

#endif
