/* tyndall.h - light one can see: shafts, shadows and haze, rendered by CPUs.
 *
 * SPDX-License-Identifier: MIT
 *
 * This header is the manual. The library allocates nothing, keeps no state outside the memory that you give it, starts no
 * threads and calls nothing of an operating system. It has two levels that can be linked and used apart:
 *
 *   (a) the rasterizer:    meshes            -> shadow maps, colour, depth       tyn_raster_...
 *   (b) the post process:  depth, colour, shadow maps -> the picture with shafts  tyn_render
 *
 * An engine with a renderer of its own needs (b) alone.
 *
 * Conventions, everywhere:
 *  - World space is right-handed; the unit of length is yours, "metres" below. Angles are radians.
 *  - Pixel (0, 0) is the top left one; it is sampled at its centre (0.5, 0.5). Rows run downwards.
 *  - Colours and light are linear RGB radiometric values: radiance W/(m2 sr), irradiance W/m2, intensity W/sr.
 *  - "Depth" is view-space depth: the distance along the camera's forward axis, not along the ray. (Depth buffers of other
 *    conventions: tyn_depth_coding, tyn_map_coding.)
 *  - Matrices are row-major 4x4, applied to column vectors: out[r] = sum over c of m[4 * r + c] * in[c].
 *  - A pointer is read only during the call it is given to, but for the memory given to an ..._init.
 *  - Every call checks its arguments before it writes anything. A negative status means that nothing was written.
 *    (One exception, because only the work itself shows it: TYN_E_EXECUTOR.)
 *  - The output is finite for finite input, and the same bytes for any number of workers.
 */
#ifndef TYNDALL_H
#define TYNDALL_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define TYN_VERSION_MAJOR 0
#define TYN_VERSION_MINOR 1
#define TYN_VERSION_PATCH 0
#define TYN_VERSION "0.1.0"

/* ---- status -------------------------------------------------------------------------------------------------------- */

typedef enum tyn_status {
    TYN_OK = 0,
    TYN_E_NULL = -1,      /* a required pointer is NULL */
    TYN_E_CONFIG = -2,    /* a field of a config is outside its range */
    TYN_E_MEMORY = -3,    /* the block is smaller than ..._measure says */
    TYN_E_ALIGN = -4,     /* the block is not aligned to TYN_ALIGNMENT, or pixels are not aligned to their components */
    TYN_E_IMAGE = -5,     /* an image has a wrong size, format, stride or coding */
    TYN_E_CAMERA = -6,    /* camera: not finite, axes not orthonormal, empty window, or not 0 < near < far */
    TYN_E_LIGHT = -7,     /* light: not finite, colour < 0, direction not of length 1, angle or shadow map out of range */
    TYN_E_MEDIUM = -8,    /* medium: not finite, coefficient < 0, or g outside -1 .. 1; or a frame's art control out of range */
    TYN_E_MESH = -9,      /* mesh: index out of range, or a material out of range */
    TYN_E_DISPLAY = -10,  /* display: not finite, exposure < 0, or an unknown tone curve */
    TYN_E_LIMIT = -11,    /* more lights, maps or media, or a larger image or shadow map, than the config has room for */
    TYN_E_EXECUTOR = -12, /* the executor did not run each job once, or used a worker number out of range; output undefined */
    TYN_E_ISA = -13       /* none of the instruction sets that the config allows is there */
} tyn_status;

/* The name of a status as a constant string, such as "TYN_E_CAMERA"; "TYN_E_UNKNOWN" for a number that is none. */
const char *tyn_status_name(tyn_status status);

/* "0.1.0": of the library that is linked, for comparison with TYN_VERSION. */
const char *tyn_version(void);

/* ---- a smaller library --------------------------------------------------------------------------------------------- */

/* Compiled with -DTYN_LEAVE_OUT=N, N the sum of some of these, the library lacks them; the rest gives the same bytes. What asks
 * for one that is not there gets the status in brackets. (What is never called the linker leaves out:
 * -ffunction-sections -fdata-sections, -Wl,--gc-sections.) */
#define TYN_PART_PREFILTERED 1 /* TYN_METHOD_PREFILTERED and _HYBRID (TYN_E_CONFIG) */
#define TYN_PART_DEBUG 2       /* debug views (TYN_E_DISPLAY) */
#define TYN_PART_GATHERS 4     /* TYN_GATHER_IVB and _ED10, downscale, TYN_METHOD_SUBSAMPLE (TYN_E_CONFIG) */
#define TYN_PART_RAYS 8        /* all of tyn_rays but TYN_RAYS_WORDS (TYN_E_CONFIG) */
#define TYN_PART_SLIDES 16     /* in tyn_render and tyn_query: textures, tints (TYN_E_LIMIT), config.textured (TYN_E_CONFIG) */
#define TYN_PART_LAMPS 32      /* spot and point lights (TYN_E_LIGHT) */
#define TYN_PART_QUADS 64      /* config.quads (TYN_E_CONFIG); the preset has it where the library does */

/* ---- work in parallel ---------------------------------------------------------------------------------------------- */

/* One job of a stage. `index` counts 0 .. count - 1; `worker` is 0 .. workers - 1. */
typedef void (*tyn_job)(void *argument, int32_t index, int32_t worker);

/* How the library runs its jobs. A NULL executor runs them in the calling thread, in order.
 * `run` must call job(argument, i, w) exactly once for every i in 0 .. count - 1, in any order, on any thread, and return
 * when all have returned. Two calls at the same time must have different w, and what a finished call wrote must be visible
 * to the caller when `run` returns. Jobs are independent: any order gives the same bytes. Fastest is a worker that gets
 * neighbouring jobs, of every call about the same part, since its caches hold what they need; and that looks for the next call
 * for some 0.1 ms before it sleeps, since calls follow one another closely. ports/posix/pool.c does so. */
typedef struct tyn_executor {
    void (*run)(void *context, tyn_job job, void *argument, int32_t count);
    void *context;   /* handed to run; may be NULL */
    int32_t workers; /* 1 .. workers of the config: w is below this */
} tyn_executor;

/* A clock for the statistics: nanoseconds from any fixed origin. NULL: no times are taken. */
typedef uint64_t (*tyn_clock)(void *context);

/* ---- instruction sets ---------------------------------------------------------------------------------------------- */

/* Vector units that kernels are compiled for. The best that the machine has is picked at init; all give the same bytes, so
 * that this is for tests, for timing, and around a broken one. The bits form a mask, later ones are better. */
typedef enum tyn_isa {
    TYN_ISA_SCALAR = 1, /* plain C; always there */
    TYN_ISA_SSE2 = 2,
    TYN_ISA_AVX2 = 4,
    TYN_ISA_AVX512 = 8, /* F, BW, DQ, VL and VBMI2 */
    TYN_ISA_NEON = 16,  /* AArch64 */
    TYN_ISA_WASM = 32   /* SIMD128 */
} tyn_isa;

/* Masks of tyn_isa: what is compiled in, and what of it this machine can run. */
int32_t tyn_isa_built(void);
int32_t tyn_isa_available(void);

/* "avx2" for TYN_ISA_AVX2 and so on; "unknown" for what is not one of them. */
const char *tyn_isa_name(int32_t isa);

/* ---- images -------------------------------------------------------------------------------------------------------- */

typedef enum tyn_format {
    TYN_FORMAT_NONE = 0,
    TYN_RGB_F32 = 1,      /* 3 floats, linear */
    TYN_RGBA8_SRGB = 2,   /* bytes R G B A, sRGB encoded; A is written as 255 */
    TYN_BGRA8_SRGB = 3,   /* bytes B G R A, else the same */
    TYN_RGB565_SRGB = 4,  /* uint16_t of the machine's byte order, red in the high 5 bits, sRGB encoded */
    TYN_DEPTH_F32 = 5,    /* float, view-space depth in metres, or as its coding says */
    TYN_RGB8_LINEAR = 6,  /* bytes R G B, value / 255; textures */
    TYN_RGB16_LINEAR = 7, /* uint16_t R G B, value / 65535; textures */
    TYN_MASK8 = 8,        /* one byte; textures that cut holes: below 128 is a hole */
    TYN_DEPTH_U16 = 9,    /* uint16_t of the machine's byte order; what it counts, its coding says */
    TYN_DEPTH_U24 = 10    /* uint32_t: the low 24 bits; the high 8 (often a stencil) are ignored */
} tyn_format;

/* A picture in the caller's memory. pixels == NULL stands for "none" where an image is optional. */
typedef struct tyn_image {
    void *pixels;     /* the top left pixel; aligned to the format's component (4 for floats, 2 for 16 bit) */
    int32_t width;    /* 1 .. TYN_MAX_SIZE */
    int32_t height;   /* 1 .. TYN_MAX_SIZE */
    ptrdiff_t stride; /* bytes from one row to the next, a multiple of the alignment; negative: bottom row first in memory;
                         0: rows follow one another without a gap */
    tyn_format format;
} tyn_image;

#define TYN_MAX_SIZE 32768

/* Bytes of one pixel; 0 for a format that is none. */
int32_t tyn_format_bytes(tyn_format format);

/* Places, lengths, depths and coefficients are refused beyond this (and a near depth below its inverse), colours of lights
 * beyond TYN_MAX_COLOUR: what is inside has room to be squared and cubed in floats. */
#define TYN_MAX_LENGTH 1e12f
#define TYN_MAX_COLOUR 1e24f

/* ---- camera -------------------------------------------------------------------------------------------------------- */

typedef enum tyn_camera_kind {
    TYN_CAMERA_PERSPECTIVE = 0,
    TYN_CAMERA_ORTHOGRAPHIC = 1 /* all view rays along `forward`; for tyn_render and the fits, not for the rasterizer */
} tyn_camera_kind;

/* The pixel plane is the window left .. right, bottom .. top: at depth 1 (perspective) or in metres (orthographic). It need not
 * be centred. A viewport inside a larger buffer: images that point at its first pixel, with the buffer's stride. */
typedef struct tyn_camera {
    tyn_camera_kind kind;
    float position[3];
    float right[3]; /* right, up, forward: of length 1 and at right angles, within 1e-3 */
    float up[3];
    float forward[3];                                   /* the way the camera looks */
    float left_edge, right_edge, bottom_edge, top_edge; /* left < right, bottom < top; symmetric: -x, x, -y, y */
    float near_depth; /* geometry nearer than this is not seen (it still casts shadows); > 0 */
    float far_depth;  /* view rays end at this depth where nothing is hit; > near */
} tyn_camera;

/* Sets all of *camera: at `position`, looking at `target`, turned such that `up` is up, full vertical angle `fov_y`
 * (0 < fov_y < pi), square pixels in an image of width x height. TYN_E_CAMERA where that gives no camera (see the struct;
 * target at position, up parallel to the view), TYN_E_NULL. */
tyn_status tyn_camera_look(tyn_camera *camera, const float position[3], const float target[3], const float up[3], float fov_y,
                           float near_depth, float far_depth, int32_t width, int32_t height);

/* Sets all of *camera from an engine's matrices, row-major for column vectors as everywhere (transpose what others hold).
 * `view` takes world to view space by a rotation and a shift; there the camera looks along -Z, +X is right and +Y up.
 * `projection` takes view space to clip space: a perspective one, off-centre or not, whose w is in proportion to -z, or an
 * orthographic one; +X in clip space is right in the picture, and Y may run either way (a negative scale of y, as for Vulkan,
 * is taken to turn it down). Its third row, the depth, is not read: -1 .. 1 or 0 .. 1, reversed or infinite are all the same
 * here, and so the nearest and farthest depth are given in metres, 0 < near < far. TYN_E_CAMERA: not finite, not such matrices
 * (view scaled, sheared, mirrored or looking along +Z; projection with a turn or mirrored in x), or near and far out of range.
 * TYN_E_NULL. */
tyn_status tyn_camera_from_matrices(tyn_camera *camera, const float view[16], const float projection[16], float near_depth,
                                    float far_depth);

/* ---- medium -------------------------------------------------------------------------------------------------------- */

typedef enum tyn_phase {
    TYN_PHASE_ISOTROPIC = 0, /* 1 / (4 pi) */
    TYN_PHASE_RAYLEIGH = 1,  /* 3 / (16 pi) (1 + cos2) */
    TYN_PHASE_HG = 2         /* Henyey and Greenstein: (1 - g2) / (4 pi (1 + g2 - 2 g cos)^1.5) */
} tyn_phase;

/* One component of a homogeneous medium that fills all space; several add up, each with its own phase function.
 * Extinction is the sum of scatter and absorb of all. No medium at all, or one of zeros, is clear air: no shafts. */
typedef struct tyn_medium {
    float scatter[3]; /* 1/m, RGB, >= 0 */
    float absorb[3];  /* 1/m, RGB, >= 0 */
    tyn_phase phase;
    float g; /* -1 < g < 1, of TYN_PHASE_HG; g > 0 scatters forward: bright towards the light. Ignored by the others */
} tyn_medium;

#define TYN_MAX_MEDIA 8

/* IVB's air at sea level (IVB section 6.8): media[0] Rayleigh, media[1] haze with g = 0.76, both multiplied by `scale`
 * (1 is the earth's air: shafts over kilometres. Small scenes want 100 and more). TYN_E_NULL, TYN_E_MEDIUM
 * (scale < 0, or so large that a frame could not have such media). */
tyn_status tyn_medium_air(tyn_medium media[2], float scale);

/* Air by what a weather report says. media[0] is Rayleigh, media[1] haze (Henyey and Greenstein, g = 0.76); nothing absorbs.
 *   turbidity:  >= 1, how much the air with its haze scatters relative to its molecules alone, at 550 nm: 1 pure air, 2 to 3
 *               clear, 10 hazy, above 30 fog. (Preetham et al. 1999 have it for a whole column of air.)
 *   visibility: metres, the meteorological range: where a black thing keeps 2 % contrast against the sky. By Koschmieder's law
 *               the extinction at 550 nm is ln(50) / visibility = 3.912 / visibility; 0: the earth's air at sea level, haze
 *               alone adds to it.
 *   angstrom:   0 .. 4, Angstrom's exponent of the haze: its scattering goes with wavelength to the power of -angstrom.
 *               0: grey, fog; 1.3: the usual haze, bluish (Angstrom 1929).
 * With R = (5.8, 13.5, 33.1) 1e-6 / m at 680, 550 and 440 nm and E = 3.912 / visibility, or R(550) turbidity with visibility 0:
 *   media[0].scatter = E / turbidity * R / R(550)
 *   media[1].scatter = E (turbidity - 1) / turbidity * (550 nm / wavelength)^angstrom
 * A small scene wants a small visibility: 300 m shows shafts in a street, 50 m in a hall.
 * TYN_E_NULL, TYN_E_MEDIUM (out of range, or a visibility so small that a frame could not have such media). */
tyn_status tyn_medium_weather(tyn_medium media[2], float turbidity, float visibility, float angstrom);

/* ---- light and its shadow map -------------------------------------------------------------------------------------- */

/* What a shadow map's texels are. */
typedef enum tyn_map_coding {
    TYN_MAP_REVERSED = 0,  /* Z / W of the matrix: 1 nearest to the light, falls with the distance, 0 at the far end */
    TYN_MAP_PROJECTED = 1, /* Z / W of the matrix: at_near nearest to the light, at_far at the far end */
    TYN_MAP_LINEAR = 2 /* stored * scale is, for a perspective matrix, W (the distance along the light's axis; Z is not used),
                          for a parallel one Z / W, the distance along the light, between at_near and at_far */
} tyn_map_coding;

/* A shadow map: for each texel the surface nearest to the light.
 * `matrix` takes a world point to (U, V, Z, W), W > 0 in front of the light: u = U / W and v = V / W are 0 .. 1 from the
 * left and from the top row; z = Z / W is what a texel holds of the nearest surface that its centre sees. What is stored at the
 * far end or beyond it, or is NaN, is nothing: all lit; values beyond the near end count as the near end.
 * z must be a projective depth (linear on planes in u and v), as every depth buffer's is: linear distance for a parallel
 * projection, a + b / distance for a perspective one. TYN_MAP_LINEAR is for maps that hold distances under a perspective.
 * The fits below make matrices for TYN_MAP_REVERSED, and that is what the rasterizer draws. */
typedef struct tyn_shadow {
    const void *depth;     /* the top left texel, aligned to the format; NULL: no shadows from this light */
    int32_t size;          /* texels of a row, 1 .. TYN_MAX_SHADOW; 0 with depth == NULL */
    float matrix[16];      /* must be invertible where depth is given */
    const tyn_image *tint; /* colour of the light in each column of the map, such as through stained glass between the light and
                              all that is seen: multiplies it. A texture as in tyn_light, over the whole map; NULL: white */
    int32_t height;        /* rows, 1 .. TYN_MAX_SHADOW; 0: as many as `size` */
    tyn_format format;     /* TYN_DEPTH_F32, also by 0, or TYN_DEPTH_U16: value / 65535, with TYN_MAP_LINEAR value * scale */
    ptrdiff_t stride;      /* bytes from row to row, as of tyn_image: 0: without a gap; negative: bottom row first. All of a map
                              spans less than 2 GiB. A multiple of 4096 is slow: rows fall into the same few places of a cache,
                              and slices go across them; with 64 bytes more thresholds take up to a fifth less time */
    tyn_map_coding coding;
    float at_near, at_far; /* projected, and linear under a parallel matrix: as in tyn_depth_coding; both 0: 0, 1. Linear under
                              a perspective one: what lies at at_far or beyond is nothing; 0: of U16 what is stored as 65535 */
    float scale;           /* linear: > 0; 0: 1 */
    float bias; /* texels, 0 .. 64: how far shadows in the air begin behind what casts them. Shafts need none: 0. Surfaces
                   have tyn_surface's */
} tyn_shadow;

#define TYN_MAX_SHADOW 16384
#define TYN_MAX_MAPS 8

typedef enum tyn_light_kind { TYN_LIGHT_DIRECTIONAL = 0, TYN_LIGHT_SPOT = 1, TYN_LIGHT_POINT = 2 } tyn_light_kind;

/* What is not covered by any of a light's shadow maps. A light without maps is lit everywhere. */
typedef enum tyn_outside {
    TYN_OUTSIDE_DEFAULT = 0, /* lit for a directional light, dark for the others */
    TYN_OUTSIDE_LIT = 1,
    TYN_OUTSIDE_DARK = 2
} tyn_outside;

typedef struct tyn_light {
    tyn_light_kind kind;
    float position[3];  /* spot and point only */
    float direction[3]; /* the way the light travels (a spot's axis), of length 1 within 1e-3; ignored for a point */
    float colour[3];    /* directional: irradiance on a plane facing the light; spot, point: radiant intensity. RGB, >= 0 */
    float angle;        /* spot: full angle of the cone, 0 < angle < 170 degrees (2.96706); its edge is hard */
    tyn_shadow shadow;
    /* Further maps, more_count of them, 0 .. TYN_MAX_MAPS - 1; NULL with 0. Each place is looked up in the first map that
     * covers it, `shadow` before these: cascades are given finest first, the faces of a point light's cube in any order. */
    const tyn_shadow *more;
    int32_t more_count;
    tyn_outside outside;
    /* Light textures, texture_count of them: multiply `colour`. TYN_RGB8_LINEAR, TYN_RGB16_LINEAR or TYN_RGB_F32; bilinear, the
     * outermost half texel holds its value. NULL with 0: none.
     *   spot:        1; a slide over the square frustum of full angle `angle`, which takes the place of the cone
     *   directional: 1; a gobo centred on the world origin, extent[0] x extent[1] metres; dark outside
     *   point:       6; the faces +X -X +Y -Y +Z -Z of a cube, oriented as in tyn_shadow_fit_cube
     * Seen along `direction`: the top row is towards `up`, the right column towards direction x up. */
    const tyn_image *textures;
    int32_t texture_count;
    float up[3];     /* spot, directional with a texture: not parallel to direction */
    float extent[2]; /* directional with a texture: > 0 */
    /* Art, not physics: both multiply the light that the medium scatters, not that on surfaces. What they make of a colour ends
     * at TYN_MAX_COLOUR. */
    float scale;   /* 0 means 1, below 0 means none: the light has no shafts, and costs nothing in tyn_render */
    float tint[3]; /* RGB, >= 0; 0 0 0 means 1 1 1 */
} tyn_light;

/* Sets light->shadow.matrix (nothing else) for rendering or reading a map of this light: for a spot the cone's square frustum,
 * for a directional light the smallest rectangle, turned about the light's direction, around what the camera can see and what
 * in the box bounds_min .. bounds_max can shadow. The box holds all geometry; both NULL: no box, all that the camera can see.
 * TYN_E_NULL, TYN_E_CAMERA, TYN_E_LIGHT, TYN_E_MESH (bounds not finite or min > max). */
tyn_status tyn_shadow_fit(tyn_light *light, const tyn_camera *camera, const float bounds_min[3], const float bounds_max[3]);

/* Sets the matrices of the six faces of a cube of maps around a point light: faces[0] is its `shadow`, faces[1] .. [5] its
 * `more`. `reach`: distance beyond which nothing matters, > 0. Sizes, if set, give the faces a margin of two texels.
 * TYN_E_NULL, TYN_E_LIGHT. */
tyn_status tyn_shadow_fit_cube(tyn_shadow faces[6], const float position[3], float reach);

/* The matrix of a map for a directional light that does not crawl: when the camera moves or turns and the light does not, the
 * map moves by whole texels over a grid that is fixed in the world, and a caster covers the same texels as before. Sets
 * shadow->matrix and nothing else; shadow->size must be set, 16 .. TYN_MAX_SHADOW. For that the map is a square around a ball
 * around all that the camera can see up to the depth `distance` (metres; 0 or beyond the far end: the far end), of constant
 * size and at a constant angle: a texel is 1.3 to 3 times as wide as tyn_shadow_fit makes it, which turns the map, and more
 * where there is a box of bounds. Casters nearer to the light than the map's near end must be clamped to it when it is rendered
 * (tyn_raster_shadow does). The grid holds while the camera is within 4 million texels of the origin.
 * TYN_E_NULL, TYN_E_CAMERA (also a distance that is negative or not beyond the near end), TYN_E_LIGHT (kind, direction, size).
 */
tyn_status tyn_shadow_snap(tyn_shadow *shadow, const tyn_light *light, const tyn_camera *camera, float distance);

/* The matrices of `count` maps, 1 .. TYN_MAX_MAPS, finest first, for a directional light: cascades[0] is its `shadow`,
 * cascades[1] .. its `more`. Cascade i covers what the camera can see from itself to the depth
 *     lambda near (distance / near)^x + (1 - lambda) (near + (distance - near) x),   x = (i + 1) / count
 * (Zhang et al. 2006): lambda 0 .. 1, from equal lengths to equal ratios; 0.5 to 0.8 serve most. `distance` as in
 * tyn_shadow_snap. Each is fitted as by tyn_shadow_fit with the bounds (both may be NULL; sizes, if set, give margins) or, with
 * `snapped` not 0, as by tyn_shadow_snap (all sizes must be set; bounds are not used). Sets the matrices and nothing else.
 * TYN_E_NULL, TYN_E_CAMERA, TYN_E_LIGHT, TYN_E_MESH (bounds), TYN_E_LIMIT (count), TYN_E_CONFIG (lambda). */
tyn_status tyn_shadow_fit_cascades(tyn_shadow *cascades, int32_t count, const tyn_light *light, const tyn_camera *camera,
                                   const float bounds_min[3], const float bounds_max[3], float distance, float lambda,
                                   int32_t snapped);

struct tyn_mesh;

/* tyn_shadow_fit, but as tight as a frame allows: around what the camera does see, by its depth buffer (TYN_DEPTH_F32, any
 * size; NULL: as far as it can see), and what those triangles can shadow that lie between it and the light (a floor under
 * everything costs no texels). Error in the shafts is in proportion to the map's width: do this where the frame allows. Changes
 * with the view: shadows crawl by parts of a texel when the camera moves. TYN_E_NULL, TYN_E_CAMERA, TYN_E_LIGHT, TYN_E_IMAGE,
 * TYN_E_ALIGN, TYN_E_LIMIT, TYN_E_MESH. */
tyn_status tyn_shadow_fit_scene(tyn_light *light, const tyn_camera *camera, const tyn_image *depth,
                                const struct tyn_mesh *meshes, int32_t mesh_count);

/* Klehm et al. 2014, section 4.2: the matrices of `count` maps, 1 .. TYN_MAX_MAPS, in which every view ray of a perspective
 * camera stays in one row at one depth, so that a rasterizer draws what shafts are computed from with nothing to resample;
 * for a directional light: maps[0] is its `shadow`, maps[1] .. its `more`. They cover all that the camera can see from the
 * depth `from` (as a near depth; 0: the near end) up to `distance` (0: the far end), one behind the other in equal ratios: the
 * more, the more even their texels. What is nearer is looked up in the maps after them, and is as `outside` says if there are
 * none: a fitted map as the last of `more` closes that gap. Casters nearer to the light must be clamped to the near end when a
 * map is rendered (tyn_raster_shadow does). Sizes, if set, give margins. For the medium alone: surfaces want a map without
 * gaps.
 * TYN_E_NULL, TYN_E_CAMERA (also orthographic; from and distance out of order or next to equal), TYN_E_LIGHT (kind, direction,
 * sizes; and where tyn_shadow_rectifiable is 0), TYN_E_LIMIT (count). */
tyn_status tyn_shadow_fit_rectified(tyn_shadow *maps, int32_t count, const tyn_light *light, const tyn_camera *camera,
                                    float from, float distance);

/* Whether those maps should be taken: a weight. With c the cosine of half the angle that the view takes up as the light sees
 * it (1: a narrow view across the light; it falls as the epipole comes nearer to the screen, and with it the worth of the
 * maps), x = (c - 0.2) / 0.2 and clamped to 0 .. 1 the weight is x x (3 - 2 x): 1 from c = 0.4 on, 0 up to 0.2 and where a view
 * ray is parallel to the light. It changes smoothly with camera and light. Where it is between 0 and 1, give the light twice,
 * with these maps and its colour times the weight, and with other maps and its colour times the rest: then nothing pops as the
 * epipole moves. 0 also for arguments that tyn_shadow_fit_rectified refuses. */
float tyn_shadow_rectifiable(const tyn_light *light, const tyn_camera *camera);

/* ---- display ------------------------------------------------------------------------------------------------------- */

typedef enum tyn_tone {
    TYN_TONE_CLAMP = 0, /* min(x, 1) per channel */
    TYN_TONE_FILM = 1   /* 1 - exp(-x) per channel: photographic film, bright light rolls off to white */
} tyn_tone;

/* From radiance to the target's format. TYN_RGB_F32 targets take the exposure alone: no tone curve, dither or encoding. */
typedef struct tyn_display {
    float exposure; /* multiplies radiance, >= 0; 0 means 1 */
    tyn_tone tone;
    int32_t dither; /* not 0: ordered 8x8 dither of one step of the target's format, against banding in fog */
} tyn_display;

/* Encodes a linear image (TYN_RGB_F32) into `target`, as tyn_render does with its result. Same size; needs no context.
 * TYN_E_NULL, TYN_E_IMAGE, TYN_E_ALIGN, TYN_E_DISPLAY. */
tyn_status tyn_encode(const tyn_image *linear, const tyn_display *display, const tyn_image *target);

/* ---- level (b): the post process ----------------------------------------------------------------------------------- */

typedef enum tyn_method {
    TYN_METHOD_EPIPOLAR = 0,  /* the default: rays along epipolar slices, interpolated (ED10, IVB and beyond) */
    TYN_METHOD_MARCH = 1,     /* a ray for each pixel: the truth that the others are held against */
    TYN_METHOD_SUBSAMPLE = 2, /* a ray for each point of a coarse grid, bilateral up-sampling (ED10's naive comparison) */
    TYN_METHOD_NONE = 3,      /* no scattered light; the surface is attenuated all the same */
    /* Klehm et al. 2014: visibility along each slice as prefiltered rows of a Fourier basis, at a cost per pixel that does not
     * depend on the scene. Approximate: some per mille of the light on the mean. See `bases` and
     * what follows it. Of the lines and pixels' ways they know TYN_GATHER_SHEAR and no downscale (PREFILTERED), or all
     * (HYBRID). Under orthographic cameras they are TYN_METHOD_MARCH and TYN_METHOD_EPIPOLAR. */
    TYN_METHOD_PREFILTERED = 4, /* looked up for every pixel; the rows of all slices are kept: tyn_measure tells */
    TYN_METHOD_HYBRID = 5       /* EPIPOLAR, with its rays looked up in the rows of the one slice in hand */
} tyn_method;

/* Of TYN_METHOD_PREFILTERED and _HYBRID: what a column of light weighs in the mean up to where a ray ends. */
typedef enum tyn_weights {
    TYN_WEIGHTS_TRANSMITTANCE = 0, /* as much as its light on its way to the camera, along reference rays */
    TYN_WEIGHTS_AVERAGE = 1        /* its width: for thin air alone */
} tyn_weights;

/* The one reference ray of a slice, with config.references 1. */
typedef enum tyn_reference {
    TYN_REFERENCE_BISECTRIX = 0, /* between the angles to the light of the slice's outermost rays */
    TYN_REFERENCE_GEOMETRIC = 1  /* the geometric mean of their sines: best for the worst ray; poor around an epipole */
} tyn_reference;

/* Bits of config.paper: back to Klehm et al., to see what is gained. */
typedef enum tyn_paper {
    TYN_PAPER_DEPTH = 1,   /* z even over the slice, not remapped by where its shadows begin */
    TYN_PAPER_RANGE = 2,   /* z over all of the period, no margin against its wrap */
    TYN_PAPER_COLUMNS = 4, /* columns that all rays see lit, or dark, in the basis like others */
    TYN_PAPER_EPIPOLE = 8  /* rays near the epipole looked up like others, not walked (the paper's figure 8) */
} tyn_paper;

/* How a ray finds its lit intervals. In slices, all but the fixed steps read the slice's row of thresholds and give the same
 * bytes; where a ray has no row (march, subsample, rejected pixels) they are an exact walk over the map's texels. */
typedef enum tyn_rays {
    TYN_RAYS_WORDS = 0,  /* compares packed into words of 32 or 64 columns, transitions by their bits */
    TYN_RAYS_STEPS = 1,  /* fixed steps inside the light's frustum, sampled in the middle of each (ED10) */
    TYN_RAYS_TREE = 2,   /* a 1D min/max tree over the row (IVB section 6.4) */
    TYN_RAYS_SWEEP = 3,  /* words that are kept while the slice's rays are taken in order: no compares, for machines without
                            vectors */
    TYN_RAYS_COLUMNS = 4 /* column by column: IVB's march without its tree, for comparison */
} tyn_rays;

/* How lines lie on the screen and how pixels are put together from them. */
typedef enum tyn_gather {
    TYN_GATHER_SHEAR = 0, /* tyndall's: samples on pixel columns or rows, lines only where the screen shows them, 2 taps; in a
                             sun's light, where none fits, those beside them and on the next outer lines */
    TYN_GATHER_IVB = 1,   /* equidistant border points, short lines stretched; 2 lines x 2 samples, bilateral (IVB section 6) */
    TYN_GATHER_ED10 = 2   /* equidistant border points; 3 to 5 taps on each of 2 lines, bilateral, and the next outer line where
                             none fits (ED10 section 4.3) */
} tyn_gather;

/* Weights of TYN_GATHER_ED10's taps, over distance and over depth. */
typedef enum tyn_kernel {
    TYN_KERNEL_GAUSSIAN = 0, /* e^(-a x^2) */
    TYN_KERNEL_SHEPARD = 1,  /* a / x^2, kept finite at 0 */
    TYN_KERNEL_THRESHOLD = 2 /* of depth: in or out */
} tyn_kernel;

typedef enum tyn_preset {
    TYN_PRESET_HANDHELD = 0,
    TYN_PRESET_BALANCED = 1,
    TYN_PRESET_QUALITY = 2, /* the default of a zeroed config */
    TYN_PRESET_REFERENCE = 3
} tyn_preset;

/* What a context is made for. Zero all of it, set width and height (or call tyn_config_preset), change what you like. */
typedef struct tyn_config {
    int32_t width; /* pixels, 1 .. TYN_MAX_SIZE: the largest image; a frame may be smaller */
    int32_t height;
    int32_t slices;        /* epipolar slices, 8 .. 65536; 0: as TYN_PRESET_QUALITY */
    int32_t samples;       /* samples along a slice, at most: one per pixel column (row), each 2nd, 4th ... so that they
                              fit; 2 .. 65536; 0: all. slices * samples: at most 2^28 */
    int32_t initial_step;  /* samples between initial rays, 1 .. 64, a power of two; 0: by size, 4 at 480 and
                              16 from 1536 on */
    float break_threshold; /* jump of depth, relative to the nearer, that counts as a break: > 0 .. 1; 0: 0.06 */
    float tolerance;       /* refinement on light: a stretch between rays is split while the middle of three misses the straight
                              line by more than this part of the unshadowed light; > 0 .. 1 (never); 0: 0.01. From 0.01 on
                              what is an eighth of initial_step long or less is not split */
    int32_t shadow_size;   /* largest shadow map of a frame, texels, 1 .. TYN_MAX_SHADOW; 0: 2048 */
    int32_t steps;         /* of TYN_RAYS_STEPS: steps per ray, 1 .. 4096; 0: 150 */
    tyn_method method;
    tyn_rays rays;
    tyn_gather gather;
    tyn_kernel kernel; /* of TYN_GATHER_ED10 */
    int32_t taps;      /* of TYN_GATHER_ED10: on each line, 3 .. 5; 0: 3 */
    int32_t downscale; /* 1, 2, 4, 8; 0: 1. Epipolar and march are computed for each such column and row, and the pixels between
                          by bilateral up-scaling; those that it does not fit have rays of their own (IVB section 6.7) */
    int32_t budget;    /* of TYN_METHOD_SUBSAMPLE: rays, about, 1 .. slices * samples; 0: as many as the slices' initial ones */
    int32_t maps;      /* most shadow maps of one light, 1 .. TYN_MAX_MAPS; 0: 1 */
    int32_t textured;  /* not 0: room for lights with textures or tints; 2 more bytes a sample */
    int32_t lights;    /* most lights in a frame, 1 .. TYN_MAX_LIGHTS; 0: 1. More than 1 costs 12 bytes a pixel */
    int32_t workers;   /* most workers of an executor, 1 .. TYN_MAX_WORKERS; 0: 1. Each costs a scratch */
    int32_t isa; /* mask of tyn_isa that may be used, the best of them is; 0: any. TYN_E_ISA from tyn_init if none is there */
    /* TYN_METHOD_PREFILTERED and _HYBRID. A slice takes columns * references * (bases + 4) bytes, three times that with
     * `textured`, and some 200 more. */
    int32_t bases;           /* sines and cosines together, 4 .. 128, a multiple of 4; 0: 32 */
    int32_t columns;         /* stored ones of a slice, 4 .. 4096; 0: 96 */
    int32_t references;      /* reference rays of a slice, 1 .. 4; 0: 4. One will do where the light is far off the screen */
    tyn_weights weights;     /* TYN_WEIGHTS_AVERAGE has one set of rows, whatever `references` says */
    tyn_reference reference; /* with references 1 */
    int32_t window;          /* not 0: no ringing (Lanczos' factors), at the price of shadows twice as soft */
    int32_t paper;           /* bits of tyn_paper; 0: none */
    /* Not 0: pixels go four at a time, 2 x 2, and through tables: for machines without vectors, a quarter of the work,
     * about 1 dB farther from the exact march. Plain C whatever the ISA. So go frames of TYN_METHOD_EPIPOLAR by
     * TYN_GATHER_SHEAR, not by TYN_RAYS_STEPS, without downscale, with samples for each pixel or each 2nd; with one light, a
     * sun without texture and tint, and an extinction that shows in each channel; with colour and target of 8 bits or 565,
     * exposure up to 1e12, no debug view, fog_scale or max_distance. All others are drawn as with 0. */
    int32_t quads;
} tyn_config;

#define TYN_MAX_LIGHTS 16
#define TYN_MAX_WORKERS 64

/* Fills all of *config for an image size. TYN_E_NULL, TYN_E_CONFIG (size or preset). */
tyn_status tyn_config_preset(tyn_config *config, tyn_preset preset, int32_t width, int32_t height);

/* Memory for a context. *bytes is exact; the block must be aligned to TYN_ALIGNMENT. TYN_E_NULL, TYN_E_CONFIG. */
tyn_status tyn_measure(const tyn_config *config, size_t *bytes);
#define TYN_ALIGNMENT 64

/* The same number as a constant expression, for a static block, of a config whose rays, gather and downscale are 0 (what others
 * add: TYN_MEMORY_TREE ... below):
 *     static union { uint64_t align[8]; uint8_t bytes[TYN_MEMORY(320, 240, 70, 161, 256, 1, 1)]; } block;
 * (and see to its alignment: TYN_ALIGNMENT). All arguments as in tyn_config, with no zeros. */
#define TYN_MEMORY(width, height, slices, samples, shadow_size, lights, workers)                                               \
    TYN_MEMORY_FULL(width, height, slices, samples, shadow_size, lights, workers, 1, 0)
#define TYN_MEMORY_FULL(width, height, slices, samples, shadow_size, lights, workers, maps, textured)                          \
    (TYN_CONTEXT_BYTES + TYNI_BYTES((size_t)(slices)*TYNI_SAMPLES(width, height, samples), 4) +                                \
     ((textured) ? TYNI_BYTES((size_t)(slices)*TYNI_SAMPLES(width, height, samples), 2) : 0) +                                 \
     ((slices) ? 3 * TYNI_BYTES((size_t)(slices) + 16, 4) : 0) +                                                               \
     ((lights) > 1 ? TYNI_BYTES((size_t)(width) * (height), 12) : 0) + TYNI_BYTES(workers, 64) +                               \
     (size_t)(workers) * (TYN_ROW_BYTES + TYN_BUNDLE_BYTES + 2 * TYNI_BYTES((size_t)(maps) * ((size_t)(shadow_size) + 4), 4) + \
                          TYNI_BYTES((2 * (size_t)(maps) * ((size_t)(shadow_size) + 4) + 63) / 64, 4) +                        \
                          4 * TYNI_BYTES(TYNI_SAMPLES(width, height, samples), 4) +                                            \
                          TYNI_PLANES(TYNI_BYTES(TYNI_RUN(TYNI_SAMPLES(width, height, samples)), 4)) +                         \
                          3 * TYNI_BYTES((TYNI_SAMPLES(width, height, samples) + 31) / 32, 4) + TYN_STATS_BYTES))
/* More, with TYN_RAYS_TREE, with TYN_RAYS_SWEEP, with TYN_GATHER_IVB or _ED10, and with downscale. */
#define TYN_MEMORY_TREE(shadow_size, maps, workers)                                                                            \
    ((size_t)(workers)*TYNI_BYTES((size_t)(maps) * ((size_t)(shadow_size) + 4) + 19, 4))
#define TYN_MEMORY_SWEEP(width, height, samples, shadow_size, maps, workers)                                                   \
    ((size_t)(workers) *                                                                                                       \
     (TYNI_BYTES(2 * (size_t)(maps) * ((size_t)(shadow_size) + 4), 4) +                                                        \
      TYNI_BYTES(2 * (size_t)(maps) * ((size_t)(shadow_size) + 4) / 32 + 2, 4) +                                               \
      TYNI_BYTES(TYNI_SAMPLES(width, height, samples) + 1, 4) + TYNI_BYTES(TYNI_SAMPLES(width, height, samples), 2)))
#define TYN_MEMORY_BORDER(slices) (TYNI_BYTES(slices, 16) + TYNI_BYTES(slices, 4))
#define TYN_MEMORY_DOWNSCALE(width, height, samples, factor, workers, textured)                                                \
    (TYNI_BYTES(TYNI_POINTS(width, factor) * TYNI_POINTS(height, factor), 4) +                                                 \
     3 * TYNI_BYTES(TYNI_POINTS(height, factor) + 16, 4) +                                                                     \
     ((textured) ? TYNI_BYTES(TYNI_POINTS(width, factor) * TYNI_POINTS(height, factor), 2) : 0) +                              \
     (TYNI_POINTS(width, factor) > TYNI_SAMPLES(width, height, samples)                                                        \
          ? 4 * (size_t)(workers) *                                                                                            \
                (TYNI_BYTES(TYNI_POINTS(width, factor), 4) - TYNI_BYTES(TYNI_SAMPLES(width, height, samples), 4))              \
          : 0))
/* More, with TYN_METHOD_HYBRID; and what TYN_METHOD_PREFILTERED takes in all. sets: references (1 with average weights), three
 * times as many with `textured`. */
#define TYN_MEMORY_HYBRID(bases, columns, sets, workers)                                                                       \
    ((size_t)(workers) * (TYNI_BYTES(1, TYNI_SHELF(bases, columns, sets)) + TYNI_BYTES(1, TYNI_MILL(bases, sets))))
#define TYN_MEMORY_PREFILTERED(width, height, slices, samples, shadow_size, lights, workers, maps, bases, columns, sets)       \
    (TYN_MEMORY_FULL(width, height, 0, samples, shadow_size, lights, workers, maps, 0) +                                       \
     TYNI_BYTES(slices, TYNI_SHELF(bases, columns, sets)) + (size_t)(workers)*TYNI_BYTES(1, TYNI_MILL(bases, sets)))
#define TYNI_SHELF(bases, columns, sets)                                                                                       \
    ((TYN_SHELF_BYTES + (size_t)(columns) * (size_t)(sets) * ((size_t)(bases) + 4) + 7) / 8 * 8)
#define TYNI_MILL(bases, sets) (4 * ((size_t)(sets) * ((size_t)(bases) + 3) + (size_t)(bases) + 520))
#define TYN_SHELF_BYTES 192
#define TYNI_POINTS(pixels, factor) (((size_t)(pixels)-1 + (size_t)(factor)-1) / (size_t)(factor) + 1)
#define TYN_CONTEXT_BYTES 2688
#define TYN_STATS_BYTES 256
#define TYN_ROW_BYTES 1152
/* What pixels have before their planes, and the least of the planes. A slice's rays lie over both. */
#define TYN_BUNDLE_BYTES 2176
#define TYNI_BYTES(count, size) (((size_t)(count) * (size) + (TYN_ALIGNMENT - 1)) / TYN_ALIGNMENT * TYN_ALIGNMENT)
#define TYNI_RUN(samples) ((size_t)((samples) < 1024 ? ((samples) + 1) / 2 : 512))
#define TYNI_PLANES(bytes) (11 * (bytes) > TYN_PLANES_BYTES ? 11 * (bytes) : TYN_PLANES_BYTES)
#define TYN_PLANES_BYTES 1792
#define TYNI_LONGER(width, height) ((width) > (height) ? (width) : (height))
#define TYNI_SAMPLES(width, height, samples)                                                                                   \
    ((size_t)((samples) < TYNI_LONGER(width, height) ? (samples) : TYNI_LONGER(width, height)))

typedef struct tyn_context tyn_context;

/* Places a context in the caller's block and gives its address (it starts there). The block belongs to the context until you
 * use it for something else; there is nothing to free. The config is copied. No render call keeps anything in it that the next
 * one reads. TYN_E_NULL, TYN_E_CONFIG, TYN_E_MEMORY, TYN_E_ALIGN, TYN_E_ISA. */
tyn_status tyn_init(tyn_context **context, const tyn_config *config, void *memory, size_t bytes);

/* What happened in a frame. Sums over lights and workers; deterministic but for the times. */
typedef struct tyn_stats {
    int64_t pixels;
    int64_t slices;     /* slices that cross the screen and the light's volume */
    int64_t culled;     /* slices laid out that miss it: nothing was done for them */
    int64_t samples;    /* samples on slices (of a grid: its points) */
    int64_t breaks;     /* discontinuities of depth between neighbouring samples */
    int64_t initial;    /* rays before refinement on light: at initial steps and breaks */
    int64_t rays;       /* rays integrated in all (march: per pixel; subsample: per grid point) */
    int64_t walks;      /* of these, near the epipole: exact, from texel to texel of the map */
    int64_t columns;    /* thresholds in the rows */
    int64_t looked;     /* nodes of the tree (or words, or columns, as config.rays is) that rays looked at */
    int64_t rejected;   /* pixels that no sample fits, computed by a ray of their own; with downscale, of the coarse picture */
    int64_t corrected;  /* with downscale: pixels that up-scaling does not fit, computed by a ray of their own */
    float rays_percent; /* (rays + rejected + corrected) in percent of the pixels */
    float looked_per_ray; /* looked / (rays - walks); 0 without rows */
    size_t memory;        /* bytes of the context */
    /* Nanoseconds on the wall; 0 without a clock. total is the sum. */
    uint64_t slice_ns;  /* slices: all up to the finished lines */
    uint64_t gather_ns; /* pixels: all after them */
    uint64_t total_ns;
    /* Nanoseconds by stage, added up over workers; 0 without a clock. */
    uint64_t sample_ns;    /* slices: lines, depth along them, breaks, initial rays */
    uint64_t row_ns;       /* slices: rows of thresholds, and their trees or sorted orders */
    uint64_t ray_ns;       /* slices: rays and refinement; grids: rays */
    uint64_t line_ns;      /* slices: interpolation along lines, storing them */
    uint64_t unwarp_ns;    /* pixels, or with downscale points, from lines */
    uint64_t correct_ns;   /* rays of rejected and corrected pixels; of all with march */
    uint64_t upscale_ns;   /* with downscale: pixels from the coarse picture */
    uint64_t composite_ns; /* phase functions, transmittance, colour, encoding */
} tyn_stats;

typedef enum tyn_debug {
    TYN_DEBUG_NONE = 0,
    TYN_DEBUG_LINES = 1,    /* the slices' lines over the darkened picture */
    TYN_DEBUG_SAMPLES = 2,  /* ray samples: initial ones white, those at breaks green, those refined on light blue */
    TYN_DEBUG_BREAKS = 3,   /* samples at breaks, green */
    TYN_DEBUG_SCATTER = 4,  /* the texture of visibility: a row is a slice, a column a sample */
    TYN_DEBUG_REJECTED = 5, /* pixels with a ray of their own: red, and yellow those of the pass after up-scaling */
    TYN_DEBUG_OUTSIDE = 6,  /* surface points outside the first light's shadow map, magenta */
    TYN_DEBUG_SOURCES =
        7,               /* the texture of IVB figure 17: a row is a slice, a column a sample, its colour its pair of sources */
    TYN_DEBUG_ROW = 8,   /* the row of the slice at debug_x, debug_y: columns to the right, positions downwards from the light;
                            lit yellow, dark blue; across it that sample's ray, bright where it gathers */
    TYN_DEBUG_TREE = 9,  /* of a context with TYN_RAYS_TREE, else TYN_E_DISPLAY: the same, and below it the levels of the tree:
                            each node from its least to its greatest threshold, those that the ray looked at bright: lit green,
                            dark red, else white */
    TYN_DEBUG_BASIS = 10 /* of a context with TYN_METHOD_PREFILTERED, else TYN_E_DISPLAY (as the views of lines and samples, 1
                            to 4 and 7, are with it): its rows. A row is a slice, a column a stored one; red: the part of the
                            light that no ray sees shadowed, green and blue: the first sine and cosine of the rest */
} tyn_debug;

/* What a depth image holds. All zero: view-space depth in metres. */
typedef enum tyn_depth_kind {
    TYN_CODING_VIEW = 0, /* view-space depth, stored * scale */
    TYN_CODING_PROJECTED =
        1, /* what a projection leaves in a depth buffer, at_near .. at_far; integers are / 65535, / 16777215 */
    TYN_CODING_DISTANCE = 2 /* distance along the pixel's ray, stored * scale */
} tyn_depth_kind;

/* Nothing is spoilt by odd values: each pixel's is decoded by itself.
 *  - NaN and +infinity: sky, which is far, the end of the view ray. So is all that is beyond the camera's far_depth.
 *  - `sky`: sky, compared with the stored value before anything else.
 *  - Else zero and negative depths, and -infinity, are 0: nothing is seen through that pixel. Depth cameras that store 0 for
 *    "unknown" have sky = 0.
 *  - Projected values beyond at_near or at_far go on as the projection does; both infinities are sky. */
typedef struct tyn_depth_coding {
    tyn_depth_kind kind;
    float scale; /* view, distance: metres of a stored 1, > 0; 0: 1. Integers count as they are: millimetres have 0.001 */
    float at_near, at_far; /* projected: value stored at the near and the far plane, -1e6 .. 1e6: 0, 1 forward; 1, 0 reversed;
                              -1, 1 OpenGL's before its viewport. Both 0: 0, 1 */
    float
        near_depth;  /* projected: the planes of that projection, 0 < near < far, which need not be the camera's. 0: they are */
    float far_depth; /* HUGE_VALF or INFINITY: a perspective without a far plane */
    int32_t has_sky; /* not 0: `sky` is a mark */
    float sky;       /* a stored value as it is: of an integer format the integer, such as 0 or 65535 */
} tyn_depth_coding;

/* One frame. Zero all of it, set what you need. */
typedef struct tyn_frame {
    tyn_camera camera;
    tyn_image
        depth; /* required: TYN_DEPTH_F32, _U16 or _U24. Values are clamped to 0 .. far; infinity and NaN mean far (sky) */
    tyn_depth_coding depth_coding; /* zeros: metres along `forward` */
    tyn_image colour; /* radiance of the surfaces without medium: TYN_RGB_F32, or an 8-bit or 565 format, decoded as sRGB with 1
                         = display white. May share pixels, stride and format with target (in place). pixels NULL: black.
                         In TYN_RGB_F32 negative values and NaN mean 0 */
    tyn_image target; /* the picture; pixels NULL: none wanted. Not a depth, not a texture format */
    tyn_image scatter;       /* L_scat as TYN_RGB_F32, without exposure; pixels NULL: none wanted */
    tyn_image transmittance; /* exp(-extinction s) as TYN_RGB_F32, 0 .. 1: with `scatter` all that is needed to put the medium
                                over a picture later; pixels NULL: none wanted */
    const tyn_light *lights; /* light_count of them, 0 .. config.lights; NULL with 0 */
    int32_t light_count;
    const tyn_medium *media; /* medium_count of them, 0 .. TYN_MAX_MEDIA; NULL with 0 */
    int32_t medium_count;
    tyn_display display;
    tyn_debug debug;              /* drawn into target instead of the picture; scatter is then not to be used */
    float debug_x, debug_y;       /* of TYN_DEBUG_ROW and _TREE: pixel coordinates; 0, 0: the middle of the picture */
    const tyn_executor *executor; /* NULL: the calling thread */
    tyn_clock clock;              /* NULL: no times */
    void *clock_context;
    tyn_stats *stats; /* NULL: not wanted */
    /* Art, not physics. Every method and tyn_query obey them alike; 0 leaves physics as it is. */
    float shaft_contrast; /* how strongly shadows show in the medium: with V the part of a ray's light that shadows leave, V
                             becomes max(0, 1 - shaft_contrast (1 - V)). 0 means 1; between 0 and 1 shafts soften while the
                             glow around them stays; above 1 they darken; below 0: no shadows in the medium at all */
    float fog_scale;    /* multiplies the extinction of surfaces (only theirs, not of the light on its way through the medium):
                           fog apart from shafts. 0 means 1, below 0 none: surfaces stay clear */
    float max_distance; /* metres along a view ray beyond which nothing scatters and nothing is attenuated any more; > 0,
                           0: no such end */
} tyn_frame;

/* Renders L = exp(-extinction s) colour + L_scat into target. All images have the depth image's size, at most the config's.
 * TYN_E_NULL, TYN_E_IMAGE, TYN_E_ALIGN, TYN_E_CAMERA, TYN_E_LIGHT, TYN_E_MEDIUM, TYN_E_DISPLAY, TYN_E_LIMIT, TYN_E_EXECUTOR. */
tyn_status tyn_render(tyn_context *context, const tyn_frame *frame);

/* A point in the picture's space: pixel coordinates as in "Conventions" (the first pixel's centre is 0.5, 0.5; fractions, and
 * places beside the picture, are welcome) and view-space depth in metres, clamped to 0 .. far; infinity and NaN mean far. */
typedef struct tyn_query_point {
    float x, y;
    float depth;
} tyn_query_point;

typedef struct tyn_query_result {
    float scatter[3];       /* L_scat from the camera to the point: radiance, without exposure */
    float transmittance[3]; /* 0 .. 1: what is left of the radiance of something at the point */
} tyn_query_result;

/* What the medium does between the camera and each of `count` points: for glass, smoke, particles, sprites, all that a depth
 * buffer does not hold. Composite as tyn_render does: transmittance * radiance + scatter, times the coverage. Something
 * transparent is drawn over a picture that is finished already: with coverage a the pixel becomes
 *     (1 - a) pixel + a (transmittance * radiance + scatter).
 * The frame may be the very one given to tyn_render: camera, lights, media, the art controls and the executor count, and of
 * `depth` the width and height alone (the image's pixels may be NULL). The rest is not looked at. Each point is computed by an
 * exact ray of its own, as TYN_METHOD_MARCH has it, and costs as much. It needs no context; several calls may run at once.
 * Jobs are 64 points each; an executor may have up to TYN_MAX_WORKERS workers. Up to TYN_MAX_LIGHTS lights.
 * A point with x or y not finite gets scatter 0 and transmittance 1. `results` must not overlap `points`.
 * TYN_E_NULL (points and results may be NULL with count 0), TYN_E_LIMIT (count < 0, too many lights or maps), TYN_E_ALIGN,
 * TYN_E_IMAGE (size), TYN_E_CAMERA, TYN_E_LIGHT, TYN_E_MEDIUM, TYN_E_EXECUTOR. */
tyn_status tyn_query(const tyn_frame *frame, const tyn_query_point *points, tyn_query_result *results, int32_t count);

/* ---- level (a): the rasterizer ------------------------------------------------------------------------------------- */

typedef struct tyn_material {
    float albedo[3];          /* 0 .. 1; multiplied by the texture */
    const tyn_image *texture; /* TYN_RGB8_LINEAR, TYN_RGB16_LINEAR or TYN_RGB_F32; bilinear, repeats; NULL: none */
    const tyn_image *mask;    /* TYN_MASK8, nearest texel, repeats; cuts holes for the camera and for shadows; NULL: none */
} tyn_material;

/* Triangles of one material. All are seen, and cast shadows, from both sides. A triangle with a corner that is not finite is
 * left out and counted. Flat shading: the normal is the triangle's own. */
typedef struct tyn_mesh {
    const float *positions;  /* 3 per vertex, world space */
    const float *texcoords;  /* 2 per vertex, (0, 0) is the texture's bottom left corner; NULL: texture and mask are ignored */
    const uint32_t *indices; /* 3 per triangle, each < vertices */
    uint32_t vertices;
    uint32_t triangles; /* 0 is legal */
    tyn_material material;
} tyn_mesh;

typedef struct tyn_raster_config {
    int32_t width; /* pixels, 1 .. TYN_MAX_SIZE: the largest image or shadow map that is drawn */
    int32_t height;
    int32_t batch;   /* triangles that go through together, 64 .. 65536; 0: 2048 */
    int32_t workers; /* 1 .. TYN_MAX_WORKERS; 0: 1 */
    int32_t isa;     /* mask of tyn_isa, as in tyn_config */
} tyn_raster_config;

typedef struct tyn_raster tyn_raster;

/* What tyn_raster_measure gives, as a constant expression for a static block. Arguments as in tyn_raster_config, no zeros. */
#define TYN_RASTER_MEMORY(width, height, batch, workers)                                                                       \
    (0 * (size_t)(width) * (size_t)(height) + TYN_RASTER_BYTES + TYNI_BYTES(batch, 128) + TYNI_BYTES(batch, 4) +               \
     TYNI_BYTES(((size_t)(batch) + 63) / 64, 24) + 2 * TYNI_BYTES(workers, 64) + TYNI_BYTES(workers, 10240) +                  \
     TYNI_BYTES(workers, 1088))
#define TYN_RASTER_BYTES 23680

/* As tyn_measure and tyn_init; TYN_E_ISA too. */
tyn_status tyn_raster_measure(const tyn_raster_config *config, size_t *bytes);
tyn_status tyn_raster_init(tyn_raster **raster, const tyn_raster_config *config, void *memory, size_t bytes);

typedef struct tyn_raster_stats {
    int64_t triangles; /* given */
    int64_t drawn;     /* left after clipping and culling: pieces that cover at least one sample */
    int64_t bad;       /* not finite, left out */
    int64_t pixels;    /* that passed the depth test */
    uint64_t total_ns; /* 0 without a clock */
} tyn_raster_stats;

/* The scene as the rasterizer sees it. */
typedef struct tyn_surface {
    tyn_camera camera;
    const tyn_mesh *meshes; /* mesh_count of them; NULL with 0 */
    int32_t mesh_count;
    const tyn_light *lights; /* with rendered shadow maps; light_count of them, 0 .. TYN_MAX_LIGHTS */
    int32_t light_count;
    const tyn_medium
        *media; /* dims spots on their way to the surface (the way to the camera is tyn_render's); may be NULL with 0 */
    int32_t medium_count;
    float ambient[3];             /* irradiance, unshadowed, >= 0 */
    float background[3];          /* radiance where nothing is hit, >= 0 */
    float shadow_bias;            /* texels; 0: 1.5. How far a surface must lie behind the map's before it is in shadow */
    tyn_image colour;             /* out: radiance of the surfaces, TYN_RGB_F32; pixels NULL: not wanted */
    tyn_image depth;              /* out: TYN_DEPTH_F32, far_depth where nothing is hit; required; same size as colour */
    const tyn_executor *executor; /* NULL: the calling thread */
    tyn_clock clock;
    void *clock_context;
    tyn_raster_stats *stats; /* NULL: not wanted */
} tyn_surface;

/* Draws the meshes as the camera sees them. Lambert: albedo / pi (ambient + sum over lights of E max(0, n l) V).
 * TYN_E_NULL, TYN_E_IMAGE, TYN_E_ALIGN, TYN_E_CAMERA, TYN_E_LIGHT, TYN_E_MEDIUM, TYN_E_MESH, TYN_E_LIMIT, TYN_E_EXECUTOR. */
tyn_status tyn_raster_surface(tyn_raster *raster, const tyn_surface *surface);

/* Draws the meshes into `depth` (floats, rows shadow->stride apart; what is between them stays) as shadow->matrix sees them;
 * shadow->depth is not read, so that it may be the same memory; its format and coding must be 0. Geometry nearer to the light
 * than the map's near end is clamped to 1, not clipped: blockers outside the view still cast. executor, clock and stats may be
 * NULL. TYN_E_NULL, TYN_E_LIGHT (shadow), TYN_E_MESH, TYN_E_LIMIT, TYN_E_EXECUTOR. */
tyn_status tyn_raster_shadow(tyn_raster *raster, const tyn_shadow *shadow, float *depth, const tyn_mesh *meshes,
                             int32_t mesh_count, const tyn_executor *executor, tyn_clock clock, void *clock_context,
                             tyn_raster_stats *stats);

#ifdef __cplusplus
}
#endif

#endif
