/* llvmpipe.c - the benchmark's scene by OpenGL on Mesa's software driver. See raster.h.
 *
 * Equal work: the same triangles, flat normals, matrices and sizes; bilinear textures without mipmaps; Lambert with one sun,
 * and a shadow look-up that compares and weights four texels. Differences, all in its favour: colour is RGBA8 (ours: three
 * floats), textures are RGBA8, and vertices are shared between triangles: a flat normal comes from the last of a triangle's
 * vertices. */
#include "raster.h"

#ifndef BENCH_EGL
#include <stdio.h>

int llvmpipe_draw(const raster_work *work, int threads, int repeats, raster_times *times, raster_picture *picture,
                  char reason[200])
{
    (void)work, (void)threads, (void)repeats, (void)times, (void)picture;
    sprintf(reason, "built without EGL and GL (pkg-config egl gl)");
    return -1;
}
#else
#define GL_GLEXT_PROTOTYPES
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GL/gl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct vertex {
    float position[3], uv[2], normal[3];
} vertex;

typedef struct part {
    GLuint texture;
    size_t first; /* index */
    GLsizei count;
} part;

typedef struct gl {
    GLuint vao, depth_program, plain, shadowed, colour_fbo, depth_fbo, map_fbo, map;
    part *parts;
    int32_t part_count;
} gl;

static const char *const depth_vs = "#version 330\nlayout(location=0) in vec3 p; uniform mat4 m;\n"
                                    "void main() { gl_Position = m * vec4(p, 1); }\n";
static const char *const depth_fs = "#version 330\nvoid main() {}\n";
static const char *const vs = "#version 330\nlayout(location=0) in vec3 p; layout(location=1) in vec2 t; layout(location=2) in "
                              "vec3 n; uniform mat4 m, s; out vec2 uv; flat out vec3 normal; out vec3 map;\n"
                              "void main() { gl_Position = m * vec4(p, 1); uv = t; normal = n; map = (s * vec4(p, 1)).xyz; }\n";
static const char *const fs = "in vec2 uv; flat in vec3 normal; in vec3 map; out vec4 colour;\n"
                              "uniform sampler2D image; uniform sampler2DShadow shadow;\n"
                              "uniform vec3 sun, light, ambient;\n"
                              "void main() {\n"
                              "    vec3 sum = ambient; float facing = dot(normal, sun);\n"
                              "#ifdef SHADOWED\n"
                              "    if (facing > 0) sum += light * (facing * texture(shadow, map));\n"
                              "#else\n"
                              "    sum += light * max(facing, 0);\n"
                              "#endif\n"
                              "    colour = vec4(texture(image, uv).rgb * sum, 1);\n"
                              "}\n";

static GLuint shader(GLenum kind, const char *head, const char *text)
{
    const char *both[2];
    GLuint s = glCreateShader(kind);
    GLint ok;
    both[0] = head;
    both[1] = text;
    glShaderSource(s, 2, both, NULL);
    glCompileShader(s);
    glGetShaderiv(s, GL_COMPILE_STATUS, &ok);
    if (!ok) {
        char log[2000];
        glGetShaderInfoLog(s, sizeof log, NULL, log);
        fprintf(stderr, "%s\n", log);
        return 0;
    }
    return s;
}

static GLuint program(const char *vertex_text, const char *head, const char *fragment_text)
{
    GLuint p = glCreateProgram();
    GLint ok;
    glAttachShader(p, shader(GL_VERTEX_SHADER, "", vertex_text));
    glAttachShader(p, shader(GL_FRAGMENT_SHADER, head, fragment_text));
    glLinkProgram(p);
    glGetProgramiv(p, GL_LINK_STATUS, &ok);
    return ok ? p : 0;
}

static GLuint texture_of(const tyn_image *image, const float albedo[3])
{
    const int32_t w = image ? image->width : 1, h = image ? image->height : 1;
    uint8_t *pixels = malloc((size_t)w * (size_t)h * 4);
    GLuint t;
    if (!pixels)
        return 0;
    for (int32_t i = 0; i < w * h; i++)
        for (int32_t c = 0; c < 4; c++) {
            float value = 255.0f;
            if (image && image->format == TYN_RGB8_LINEAR && c < 3)
                value = ((const uint8_t *)image->pixels)[3 * i + c];
            else if (image && image->format == TYN_RGB16_LINEAR && c < 3)
                value = ((const uint16_t *)image->pixels)[3 * i + c] / 257.0f;
            pixels[4 * i + c] = (uint8_t)(value * (c < 3 ? albedo[c] : 1.0f) + 0.5f);
        }
    glGenTextures(1, &t);
    glBindTexture(GL_TEXTURE_2D, t);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, w, h, 0, GL_RGBA, GL_UNSIGNED_BYTE, pixels);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    free(pixels);
    return t;
}

static void normal_of(const tyn_mesh *mesh, const uint32_t *index, const raster_work *w, float n[3])
{
    const float *p[3];
    float a[3], b[3], length, side = 0;
    for (int i = 0; i < 3; i++)
        p[i] = mesh->positions + 3 * (size_t)index[i];
    for (int c = 0; c < 3; c++) {
        a[c] = p[1][c] - p[0][c];
        b[c] = p[2][c] - p[0][c];
    }
    for (int c = 0; c < 3; c++)
        n[c] = a[(c + 1) % 3] * b[(c + 2) % 3] - a[(c + 2) % 3] * b[(c + 1) % 3];
    length = sqrtf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (int c = 0; c < 3; c++)
        side += n[c] * (p[0][c] - w->camera.position[c]);
    for (int c = 0; c < 3; c++)
        n[c] = length > 0 ? n[c] / (side > 0 ? -length : length) : 0;
}

/* All meshes in one buffer. A triangle's last vertex carries its normal: one that no other triangle has claimed, if there is
 * one among the three, else a copy. */
static int load_meshes(gl *g, const raster_work *w)
{
    const scene *s = w->scene;
    size_t triangles = 0, vertices = 0, at = 0, from = 0, filled;
    uint32_t *index;
    uint8_t *claimed;
    vertex *v;
    GLuint buffer[2];
    for (int32_t i = 0; i < s->mesh_count; i++) {
        triangles += s->meshes[i].triangles;
        vertices += s->meshes[i].vertices;
    }
    index = malloc(triangles * 3 * sizeof *index);
    v = calloc(vertices + triangles, sizeof *v);
    claimed = calloc(vertices, 1);
    g->parts = calloc((size_t)s->mesh_count, sizeof *g->parts);
    g->part_count = s->mesh_count;
    if (!index || !v || !claimed || !g->parts)
        return -1;
    filled = vertices;
    for (int32_t m = 0; m < s->mesh_count; m++) {
        const tyn_mesh *mesh = &s->meshes[m];
        for (uint32_t i = 0; i < mesh->vertices; i++) {
            memcpy(v[from + i].position, mesh->positions + 3 * (size_t)i, 12);
            if (mesh->texcoords) {
                v[from + i].uv[0] = mesh->texcoords[2 * (size_t)i];
                v[from + i].uv[1] = 1.0f - mesh->texcoords[2 * (size_t)i + 1];
            }
        }
        g->parts[m].texture = texture_of(mesh->texcoords ? mesh->material.texture : NULL, mesh->material.albedo);
        g->parts[m].first = at;
        g->parts[m].count = (GLsizei)(3 * mesh->triangles);
        for (uint32_t t = 0; t < mesh->triangles; t++) {
            const uint32_t *corner = mesh->indices + 3 * (size_t)t;
            uint32_t last = 2, own;
            while (last > 0 && claimed[from + corner[last]])
                last--;
            own = (uint32_t)from + corner[last];
            if (claimed[own]) {
                v[filled] = v[own];
                own = (uint32_t)filled++;
            } else
                claimed[own] = 1;
            normal_of(mesh, corner, w, v[own].normal);
            index[at++] = (uint32_t)from + corner[(last + 1) % 3];
            index[at++] = (uint32_t)from + corner[(last + 2) % 3];
            index[at++] = own;
        }
        from += mesh->vertices;
    }
    glGenVertexArrays(1, &g->vao);
    glBindVertexArray(g->vao);
    glGenBuffers(2, buffer);
    glBindBuffer(GL_ARRAY_BUFFER, buffer[0]);
    glBufferData(GL_ARRAY_BUFFER, (GLsizeiptr)(filled * sizeof *v), v, GL_STATIC_DRAW);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffer[1]);
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, (GLsizeiptr)(at * sizeof *index), index, GL_STATIC_DRAW);
    for (GLuint i = 0; i < 3; i++) {
        static const size_t offset[3] = {0, 12, 20};
        glEnableVertexAttribArray(i);
        glVertexAttribPointer(i, i == 1 ? 2 : 3, GL_FLOAT, GL_FALSE, sizeof *v, (const void *)offset[i]);
    }
    free(index);
    free(v);
    free(claimed);
    return 0;
}

static GLuint target(GLenum format, int32_t width, int32_t height)
{
    GLuint t;
    glGenTextures(1, &t);
    glBindTexture(GL_TEXTURE_2D, t);
    glTexStorage2D(GL_TEXTURE_2D, 1, format, width, height);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    return t;
}

static GLuint frame_of(GLuint colour, GLuint depth)
{
    GLuint f;
    glGenFramebuffers(1, &f);
    glBindFramebuffer(GL_FRAMEBUFFER, f);
    if (colour)
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, colour, 0);
    else
        glDrawBuffer(GL_NONE);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth, 0);
    return glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE ? f : 0;
}

/* Depth runs as ours: 1 (the camera's: near / depth) is nearest. Row 0 of a picture is its top. */
static void camera_matrix(const raster_work *w, float m[16])
{
    const tyn_camera *c = &w->camera;
    const float sx = 2 / (c->right_edge - c->left_edge), sy = -2 / (c->top_edge - c->bottom_edge);
    const float mx = -(c->right_edge + c->left_edge) * 0.5f * sx, my = -(c->top_edge + c->bottom_edge) * 0.5f * sy;
    float dot[3] = {0, 0, 0};
    for (int i = 0; i < 3; i++) {
        dot[0] -= c->right[i] * c->position[i];
        dot[1] -= c->up[i] * c->position[i];
        dot[2] -= c->forward[i] * c->position[i];
    }
    for (int i = 0; i < 4; i++) {
        const float r = i < 3 ? c->right[i] : dot[0], u = i < 3 ? c->up[i] : dot[1], f = i < 3 ? c->forward[i] : dot[2];
        m[i] = sx * r + mx * f;
        m[4 + i] = sy * u + my * f;
        m[8 + i] = i == 3 ? c->near_depth : 0;
        m[12 + i] = f;
    }
}

static void map_matrix(const raster_work *w, float m[16])
{
    const float *s = w->light.shadow.matrix;
    for (int i = 0; i < 4; i++) {
        m[i] = 2 * s[i] - s[12 + i];
        m[4 + i] = 2 * s[4 + i] - s[12 + i];
        m[8 + i] = s[8 + i];
        m[12 + i] = s[12 + i];
    }
}

static void set_uniforms(GLuint p, const raster_work *w)
{
    const float pi = 3.14159265f;
    float m[16], biased[16], sun[3], light[3], ambient[3];
    camera_matrix(w, m);
    memcpy(biased, w->light.shadow.matrix, sizeof biased);
    biased[11] += 1e-3f;
    for (int c = 0; c < 3; c++) {
        sun[c] = -w->light.direction[c];
        light[c] = w->light.colour[c] / pi;
        ambient[c] = w->ambient[c] / pi;
    }
    glUseProgram(p);
    glUniformMatrix4fv(glGetUniformLocation(p, "m"), 1, GL_TRUE, m);
    glUniformMatrix4fv(glGetUniformLocation(p, "s"), 1, GL_TRUE, biased);
    glUniform3fv(glGetUniformLocation(p, "sun"), 1, sun);
    glUniform3fv(glGetUniformLocation(p, "light"), 1, light);
    glUniform3fv(glGetUniformLocation(p, "ambient"), 1, ambient);
    glUniform1i(glGetUniformLocation(p, "image"), 0);
    glUniform1i(glGetUniformLocation(p, "shadow"), 1);
}

static void draw(const gl *g, const raster_work *w, int pass)
{
    const GLuint p = pass == RASTER_PLAIN ? g->plain : pass == RASTER_SHADOWED ? g->shadowed : g->depth_program;
    const int32_t width = pass == RASTER_MAP ? w->map : w->width, height = pass == RASTER_MAP ? w->map : w->height;
    glBindFramebuffer(GL_FRAMEBUFFER, pass == RASTER_MAP ? g->map_fbo : pass == RASTER_DEPTH ? g->depth_fbo : g->colour_fbo);
    glViewport(0, 0, width, height);
    glUseProgram(p);
    if (p == g->depth_program) {
        float m[16];
        if (pass == RASTER_MAP)
            map_matrix(w, m);
        else
            camera_matrix(w, m);
        glUniformMatrix4fv(glGetUniformLocation(p, "m"), 1, GL_TRUE, m);
    }
    if (pass == RASTER_MAP)
        glEnable(GL_DEPTH_CLAMP);
    else
        glDisable(GL_DEPTH_CLAMP);
    glClear(GL_DEPTH_BUFFER_BIT | (p == g->depth_program ? 0 : GL_COLOR_BUFFER_BIT));
    for (int32_t i = 0; i < g->part_count; i++) {
        if (p != g->depth_program)
            glBindTexture(GL_TEXTURE_2D, g->parts[i].texture);
        glDrawElements(GL_TRIANGLES, g->parts[i].count, GL_UNSIGNED_INT, (const void *)(g->parts[i].first * 4));
    }
    glFinish();
}

static int start(void)
{
    static const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION, 4, EGL_CONTEXT_MINOR_VERSION, 5, EGL_NONE};
    EGLDisplay display = eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, NULL);
    EGLContext context;
    if (!display || !eglInitialize(display, NULL, NULL) || !eglBindAPI(EGL_OPENGL_API))
        return -1;
    context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes);
    return context && eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context) ? 0 : -1;
}

static int make(gl *g, const raster_work *w)
{
    GLuint colour, depth;
    memset(g, 0, sizeof *g);
    g->depth_program = program(depth_vs, "", depth_fs);
    g->plain = program(vs, "#version 330\n", fs);
    g->shadowed = program(vs, "#version 330\n#define SHADOWED\n", fs);
    if (!g->depth_program || !g->plain || !g->shadowed || load_meshes(g, w) != 0)
        return -1;
    set_uniforms(g->plain, w);
    set_uniforms(g->shadowed, w);
    colour = target(GL_RGBA8, w->width, w->height);
    depth = target(GL_DEPTH_COMPONENT32F, w->width, w->height);
    g->map = target(GL_DEPTH_COMPONENT32F, w->map, w->map);
    g->colour_fbo = frame_of(colour, depth);
    g->depth_fbo = frame_of(0, depth);
    g->map_fbo = frame_of(0, g->map);
    glActiveTexture(GL_TEXTURE1);
    glBindTexture(GL_TEXTURE_2D, g->map);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_FUNC, GL_GEQUAL);
    glActiveTexture(GL_TEXTURE0);
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GREATER);
    glClearDepth(0);
    glClearColor(w->background[0], w->background[1], w->background[2], 1);
    return g->colour_fbo && g->depth_fbo && g->map_fbo && glGetError() == GL_NO_ERROR ? 0 : -1;
}

/* After the plain pass. */
static void read_back(const gl *g, const raster_work *w, raster_picture *p)
{
    const size_t pixels = (size_t)w->width * (size_t)w->height;
    draw(g, w, RASTER_PLAIN);
    glReadPixels(0, 0, w->width, w->height, GL_RGB, GL_FLOAT, p->rgb);
    glReadPixels(0, 0, w->width, w->height, GL_DEPTH_COMPONENT, GL_FLOAT, p->depth);
    for (size_t i = 0; i < pixels; i++) {
        const float z = p->depth[i];
        p->depth[i] = z > 0 ? fminf(w->camera.near_depth / z, w->camera.far_depth) : w->camera.far_depth;
    }
    glBindFramebuffer(GL_FRAMEBUFFER, g->map_fbo);
    glReadPixels(0, 0, w->map, w->map, GL_DEPTH_COMPONENT, GL_FLOAT, p->map);
}

int llvmpipe_draw(const raster_work *work, int threads, int repeats, raster_times *times, raster_picture *picture,
                  char reason[200])
{
    char number[8];
    gl g;
    snprintf(number, sizeof number, "%d", threads);
    setenv("LP_NUM_THREADS", number, 1);
    setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
    setenv("GALLIUM_DRIVER", "llvmpipe", 1);
    if (start() != 0) {
        snprintf(reason, 200, "no EGL context with OpenGL 4.5 without a surface");
        return -1;
    }
    if (!strstr((const char *)glGetString(GL_RENDERER), "llvmpipe") || make(&g, work) != 0) {
        snprintf(reason, 200, "the driver is not llvmpipe, or lacks something: %s", (const char *)glGetString(GL_RENDERER));
        return -1;
    }
    for (int i = 0; i < repeats + 2; i++) /* two rounds to compile shaders */
        for (int pass = 0; pass < RASTER_PASSES; pass++) {
            const double start_ms = raster_now();
            draw(&g, work, pass);
            if (i > 1)
                times->ms[pass] = fmin(times->ms[pass], raster_now() - start_ms);
        }
    read_back(&g, work, picture);
    return 0;
}
#endif
