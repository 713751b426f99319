/* test_scene.c - the scene parser: for each rule of the format what passes and what fails, with the place of the mistake. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "files.h"
#include "parse.h"
#include "test.h"
#include "text.h"

#define FIRST "tyndall-scene 1\n"
#define IMAGE "image 64 48\n"
#define CAMERA "camera position 0 1 5 target 0 1 0 fov_y 50 near 0.1 far 100\n"
#define BACK "background 0.1 0.2 0.3\n"
#define HEAD FIRST IMAGE CAMERA BACK /* what comes after it stands on line 5 */
#define SUN "light directional direction 1 -1 0 irradiance 1 2 3"
#define SPOT "light spot position 0 5 0 target 0 0 0 angle 40 intensity 1 2 3"

typedef struct scene_case {
    const char *text;
    int line; /* of the mistake; 0: a right scene */
    const char *token, *says;
} scene_case;

static const scene_case cases[] = {
    /* The frame. */
    {HEAD, 0, "", ""},
    {"", 1, "tyndall-scene", "missing"},
    {"# nothing\n\n   \n", 3, "tyndall-scene", "missing"},
    {"image 64 48\n" FIRST, 1, "image", "first directive"},
    {"tyndall-scene\n", 1, "tyndall-scene", "version"},
    {"tyndall-scene 2\n", 1, "2", "version"},
    {"tyndall-scene 1.0\n", 1, "1.0", "version"},
    {"tyndall-scene 1 1\n", 1, "1", "too many"},
    {HEAD FIRST, 5, "tyndall-scene", "twice"},
    {"\n# comment\n  tyndall-scene 1 # one\n" IMAGE CAMERA "\t" BACK, 0, "", ""},
    {"tyndall-scene 1\r\nimage 64 48\r\n" CAMERA "background 1 2 3\r\n", 0, "", ""},
    {FIRST IMAGE CAMERA "background 1 2 3", 0, "", ""},
    {FIRST IMAGE CAMERA "background 1 2 3#comment", 0, "", ""},
    {HEAD "Image 1 1\n", 5, "Image", "unknown directive"},
    {HEAD "ligth spot\n", 5, "ligth", "unknown directive"},
    {HEAD "\x1b[2J\n", 5, "?[2J", "unknown directive"},
    {FIRST CAMERA BACK, 3, "image", "missing"},
    {FIRST IMAGE BACK, 3, "camera", "missing"},
    {FIRST IMAGE CAMERA, 3, "background", "missing"},
    {HEAD IMAGE, 5, "image", "twice"},
    {HEAD CAMERA, 5, "camera", "twice"},
    {HEAD BACK, 5, "background", "twice"},
    {HEAD "ambient 1 1 1\n", 0, "", ""},
    {HEAD "ambient 1 1 1\nambient 1 1 1\n", 6, "ambient", "twice"},
    /* image */
    {FIRST "image 32768 1\n" CAMERA BACK, 0, "", ""},
    {FIRST "image 6.4e1 0x30\n" CAMERA BACK, 0, "", ""},
    {FIRST "image 0 48\n" CAMERA BACK, 2, "0", "whole number"},
    {FIRST "image 32769 48\n" CAMERA BACK, 2, "32769", "whole number"},
    {FIRST "image 64 48.5\n" CAMERA BACK, 2, "48.5", "whole number"},
    {FIRST "image 64 -48\n" CAMERA BACK, 2, "-48", "whole number"},
    {FIRST "image 64\n" CAMERA BACK, 2, "image", "missing"},
    {FIRST "image 64 48 3\n" CAMERA BACK, 2, "3", "too many"},
    {FIRST "image 64x48\n" CAMERA BACK, 2, "64x48", "number"},
    /* background, ambient */
    {FIRST IMAGE CAMERA "background 0 0\n", 4, "background", "missing"},
    {FIRST IMAGE CAMERA "background 0 0 -1\n", 4, "-1", "0 or more"},
    {FIRST IMAGE CAMERA "background 0 0 nan\n", 4, "nan", "finite"},
    {FIRST IMAGE CAMERA "background 0 0 inf\n", 4, "inf", "finite"},
    {FIRST IMAGE CAMERA "background 0 0 1e39\n", 4, "1e39", "finite"},
    {FIRST IMAGE CAMERA "background 0 0 1e\n", 4, "1e", "finite"},
    {FIRST IMAGE CAMERA "background 0 0 1.2.3\n", 4, "1.2.3", "finite"},
    {FIRST IMAGE CAMERA "background 0 0 1,5\n", 4, "1,5", "finite"},
    {FIRST IMAGE CAMERA "background 0 0 1f\n", 4, "1f", "finite"},
    {FIRST IMAGE CAMERA "background 0 1e3 0x1.8p1\n", 0, "", ""},
    {FIRST IMAGE CAMERA "background 0 +1 .5\n", 0, "", ""},
    {FIRST IMAGE CAMERA "background 0 0 0 0\n", 4, "0", "too many"},
    {HEAD "ambient 0 0 -0.1\n", 5, "-0.1", "0 or more"},
    /* camera */
    {FIRST IMAGE BACK "camera far 9 near 1 fov_y 50 up 0 0 1 target 0 0 0 position 1 1 1\n", 0, "", ""},
    {FIRST IMAGE BACK "camera far 9 near 1 fov_y 50 up 0 0 1 target 0 0 0\n", 4, "camera", "'position'"},
    {FIRST IMAGE BACK "camera far 9 near 1 fov_y 50 position 0 0 0\n", 4, "camera", "'target'"},
    {FIRST IMAGE BACK "camera far 9 near 1 target 0 0 1 position 0 0 0\n", 4, "camera", "'fov_y'"},
    {FIRST IMAGE BACK "camera far 9 fov_y 50 target 0 0 1 position 0 0 0\n", 4, "camera", "'near'"},
    {FIRST IMAGE BACK "camera near 9 fov_y 50 target 0 0 1 position 0 0 0\n", 4, "camera", "'far'"},
    {FIRST IMAGE BACK "camera near 1 near 1 far 9 fov_y 50 target 0 0 1 position 0 0 0\n", 4, "near", "twice"},
    {FIRST IMAGE BACK "camera near 1 far 9 fov_y 50 target 0 0 1 position 0 0 0 zoom 2\n", 4, "zoom", "unknown key"},
    {FIRST IMAGE BACK "camera near 1 far 9 fov_y 50 target 0 0 1 position 0 0\n", 4, "position", "missing"},
    {FIRST IMAGE BACK "camera near 1 far 9 fov_y 50 target 0 0 1 2 position 0 0 0\n", 4, "2", "too many"},
    {FIRST IMAGE BACK "camera near 1 far 9 fov_y 0 target 0 0 1 position 0 0 0\n", 4, "0", "between"},
    {FIRST IMAGE BACK "camera near 1 far 9 fov_y 180 target 0 0 1 position 0 0 0\n", 4, "180", "between"},
    {FIRST IMAGE BACK "camera near 1 far 9 fov_y 179.9 target 0 0 1 position 0 0 0\n", 0, "", ""},
    {FIRST IMAGE BACK "camera near 0 far 9 fov_y 50 target 0 0 1 position 0 0 0\n", 4, "0", "above 0"},
    {FIRST IMAGE BACK "camera near 9 far 9 fov_y 50 target 0 0 1 position 0 0 0\n", 4, "far", "near"},
    {FIRST IMAGE BACK "camera near 1 far 9 fov_y 50 target 1 2 3 position 1 2 3\n", 4, "target", "at the position"},
    {FIRST IMAGE BACK "camera near 1 far 9 fov_y 50 target 0 0 1 position 0 0 0 up 0 0 0\n", 4, "up", "length 0"},
    {FIRST IMAGE BACK "camera near 1 far 9 fov_y 50 target 0 0 1 position 0 0 0 up 0 0 -3\n", 4, "up", "parallel"},
    {FIRST IMAGE BACK "camera near 1 far 9 fov_y 50 target 0 1 0 position 0 0 0\n", 4, "camera", "parallel"},
    /* medium */
    {HEAD "medium scatter 0 0 0 phase isotropic\n", 0, "", ""},
    {HEAD "medium phase hg -0.99 absorb 1 1 1 scatter 1 2 3\nmedium scatter 1 1 1 phase rayleigh\n", 0, "", ""},
    {HEAD "medium phase isotropic\n", 5, "medium", "'scatter'"},
    {HEAD "medium scatter 1 1 1\n", 5, "medium", "'phase'"},
    {HEAD "medium scatter 1 1 1 phase\n", 5, "phase", "missing"},
    {HEAD "medium scatter 1 1 1 phase mie\n", 5, "mie", "phase function"},
    {HEAD "medium scatter 1 1 1 phase hg\n", 5, "hg", "missing"},
    {HEAD "medium scatter 1 1 1 phase hg 1\n", 5, "1", "between"},
    {HEAD "medium scatter 1 1 1 phase hg -1\n", 5, "-1", "between"},
    {HEAD "medium scatter 1 1 1 phase hg x\n", 5, "x", "finite"},
    {HEAD "medium scatter 1 1 1 phase isotropic 0.5\n", 5, "0.5", "too many"},
    {HEAD "medium scatter 1 -1 1 phase isotropic\n", 5, "-1", "0 or more"},
    {HEAD "medium scatter 1 1 1 absorb 0 0 -2 phase isotropic\n", 5, "-2", "0 or more"},
    {HEAD "medium scatter 1 1 1 phase isotropic phase rayleigh\n", 5, "phase", "twice"},
    /* light directional */
    {HEAD SUN "\n", 0, "", ""},
    {HEAD SUN " texture ok.ppm extent 2 3 up 0 0 1\n", 0, "", ""},
    {HEAD "light\n", 5, "light", "kind"},
    {HEAD "light area\n", 5, "area", "kind"},
    {HEAD "light directional irradiance 1 1 1\n", 5, "light", "'direction'"},
    {HEAD "light directional direction 1 1 1\n", 5, "light", "'irradiance'"},
    {HEAD "light directional direction 0 0 0 irradiance 1 1 1\n", 5, "direction", "length 0"},
    {HEAD "light directional direction 0 0 1e-44 irradiance 1 1 1\n", 0, "", ""},
    {HEAD "light directional direction 1 0 0 irradiance 1 1 -1\n", 5, "-1", "0 or more"},
    {HEAD SUN " texture ok.ppm\n", 5, "light", "'extent'"},
    {HEAD SUN " texture ok.ppm extent 1 1\n", 5, "light", "'up'"},
    {HEAD SUN " up 0 1 0\n", 5, "light", "'texture'"},
    {HEAD SUN " extent 1 1 up 0 1 0\n", 5, "light", "'texture'"},
    {HEAD SUN " texture ok.ppm extent 0 1 up 0 1 0\n", 5, "0", "above 0"},
    {HEAD SUN " texture ok.ppm extent 1 1 up 0 0 0\n", 5, "up", "length 0"},
    {HEAD SUN " texture ok.ppm extent 1 1 up -2 2 0\n", 5, "up", "parallel"},
    {HEAD SUN " texture none.ppm extent 1 1 up 0 1 0\n", 5, "none.ppm", "can't be read"},
    {HEAD SUN " texture\n", 5, "texture", "missing"},
    {HEAD SUN " angle 3\n", 5, "angle", "unknown key"},
    /* light spot */
    {HEAD SPOT "\n", 0, "", ""}, /* straight down: its default up is parallel, but has no meaning */
    {HEAD SPOT " texture ok.ppm\n", 5, "light", "parallel"},
    {HEAD SPOT " texture ok.ppm up 0 -1 0\n", 5, "up", "parallel"},
    {HEAD SPOT " texture ok.ppm up 0 0 1\n", 0, "", ""},
    {HEAD SPOT " up 0 0 0\n", 5, "up", "length 0"},
    {HEAD "light spot position 0 5 0 target 0 5 0 angle 40 intensity 1 2 3\n", 5, "target", "at the position"},
    {HEAD "light spot position 0 5 0 target 0 0 0 angle 170 intensity 1 2 3\n", 5, "170", "between"},
    {HEAD "light spot position 0 5 0 target 0 0 0 angle 0 intensity 1 2 3\n", 5, "0", "between"},
    {HEAD "light spot position 0 5 0 target 0 0 0 angle 169.99 intensity 1 2 3\n", 0, "", ""},
    {HEAD "light spot position 0 5 0 target 0 0 0 intensity 1 2 3\n", 5, "light", "'angle'"},
    {HEAD "light spot position 0 5 0 angle 40 intensity 1 2 3\n", 5, "light", "'target'"},
    {HEAD "light spot target 0 5 0 angle 40 intensity 1 2 3\n", 5, "light", "'position'"},
    {HEAD "light spot position 0 5 0 target 0 0 0 angle 40\n", 5, "light", "'intensity'"},
    {HEAD SPOT " extent 1 1\n", 5, "extent", "unknown key"},
    /* light point */
    {HEAD "light point position 0 0 0 intensity 1 1 1\n", 0, "", ""},
    {HEAD "light point position 0 0 0\n", 5, "light", "'intensity'"},
    {HEAD "light point intensity 1 1 1\n", 5, "light", "'position'"},
    {HEAD "light point position 0 0 0 intensity -1 1 1\n", 5, "-1", "0 or more"},
    {HEAD "light point position 0 0 0 intensity 1 1 1 target 0 0 0\n", 5, "target", "unknown key"},
    /* mesh */
    {HEAD "mesh ok.obj\n", 0, "", ""},
    {HEAD "mesh ok.obj rotate 0 1 0 90 scale 2 translate 1 2 3 albedo 1 1 1\n", 0, "", ""},
    {HEAD "mesh\n", 5, "mesh", "missing"},
    {HEAD "mesh none.obj\n", 5, "none.obj", "can't be read"},
    {HEAD "mesh .\n", 5, ".", "folder"},
    {HEAD "mesh /dev/zero\n", 5, "/dev/zero", "not a file"},
    {HEAD "mesh ok.obj scale 0\n", 5, "0", "above 0"},
    {HEAD "mesh ok.obj scale 1e38 translate 3e38 0 0\n", 5, "ok.obj", "range"},
    {HEAD "mesh ok.obj rotate 0 0 0 30\n", 5, "rotate", "length 0"},
    {HEAD "mesh ok.obj rotate 0 1 0\n", 5, "rotate", "missing"},
    {HEAD "mesh ok.obj albedo 0 0 1.1\n", 5, "1.1", "0 to 1"},
    {HEAD "mesh ok.obj albedo 1 1 1 albedo 1 1 1\n", 5, "albedo", "twice"},
    {HEAD "mesh ok.obj ok.obj\n", 5, "ok.obj", "unknown key"},
    /* quad, box */
    {HEAD "quad a 0 0 0 b 1 0 0 c 0 1 0 albedo 0 0.5 1\n", 0, "", ""},
    {HEAD "quad a 0 0 0 b 1 0 0 c 0 1 0\n", 5, "quad", "'albedo'"},
    {HEAD "quad a 0 0 0 b 1 0 0 albedo 1 1 1\n", 5, "quad", "'c'"},
    {HEAD "quad a 0 0 0 b 1 0 0 c 0 1 0 albedo 0 0.5 -1\n", 5, "-1", "0 to 1"},
    {HEAD "quad a -3e38 0 0 b 3e38 0 0 c 0 1 0 albedo 1 1 1\n", 5, "quad", "range"},
    {HEAD "box min 0 0 0 max 0 0 0 albedo 1 1 1\n", 0, "", ""},
    {HEAD "box min 0 0 0 max 1 1 1\n", 5, "box", "'albedo'"},
    {HEAD "box max 1 1 1 albedo 1 1 1\n", 5, "box", "'min'"},
    {HEAD "box min 0 0 0 albedo 1 1 1\n", 5, "box", "'max'"},
    {HEAD "box min 0 2 0 max 1 1 1 albedo 1 1 1\n", 5, "min", "above max in y"},
    {HEAD "box min 0 0 0 max 1 1 1 albedo 1 1 2\n", 5, "2", "0 to 1"},
};

static void check_case(const scene_case *c, const char *name)
{
    const char *path = files_text("case.scene", c->text);
    char place[128];
    tool_error error;
    scene s;
    int result = scene_load(&s, path, &error);
    snprintf(place, sizeof place, "case.scene:%d: '%s", c->line, c->token);
    int good = c->line == 0 ? result == 0 : result == -1 && strstr(error.text, place) && strstr(error.text, c->says);
    if (!good)
        printf("  %s: \"%s\" gave: %s\n", name, c->text, result == 0 ? "no error" : error.text);
    CHECK(good);
    CHECK(result == 0 || (s.mesh_count == 0 && s.images == NULL));
    scene_free(&s);
}

static void test_values(void)
{
    static const char lines[] = HEAD "ambient 4 5 6\nmedium scatter 1 2 3 phase hg 0.5\nmedium scatter 1 1 1 phase hg 0.5\n"
                                     "light directional direction 0 -3 4 irradiance 7 8 9\n" SPOT "\n"
                                     "box min 0 0 0 max 1 2 3 albedo 1 0 0\nquad a 0 0 0 b 1 0 0 c 0 0 9 albedo 1 0 0\n"
                                     "mesh ok.obj scale 2 rotate 0 1 0 90 translate 10 20 30\n";
    tool_error error;
    float min[3], max[3];
    scene s;
    tyn_camera camera;
    TEST("a scene's values arrive");
    CHECK(scene_load(&s, files_text("case.scene", lines), &error) == 0);
    CHECK(s.width == 64 && s.height == 48);
    CHECK_NEAR(s.camera.fov_y, 0.872665f, 1e-6);
    CHECK(s.camera.up[1] == 1.0f && s.camera.position[2] == 5.0f);
    CHECK(s.background[2] == 0.3f && s.ambient[0] == 4.0f);
    CHECK(s.medium_count == 1 && s.media[0].scatter[1] == 3.0f && s.media[0].g == 0.5f); /* one phase function: added up */
    CHECK(s.light_count == 2 && s.lights[0].line == 8);
    CHECK_NEAR(s.lights[0].light.direction[1], -0.6f, 1e-6);
    CHECK_NEAR(s.lights[1].light.direction[1], -1.0f, 1e-6);
    CHECK(s.mesh_count == 2 && s.meshes[0].triangles == 14 && s.meshes[0].vertices == 12);
    /* (1, 0, 0) turned by 90 degrees about +y is (0, 0, -1) */
    CHECK_NEAR(s.meshes[1].positions[3], 10.0f, 1e-5);
    CHECK_NEAR(s.meshes[1].positions[4], 20.0f, 1e-5);
    CHECK_NEAR(s.meshes[1].positions[5], 28.0f, 1e-5);
    CHECK(s.meshes[1].material.albedo[0] == 0.7f);
    CHECK(scene_bounds(&s, min, max) == 1);
    CHECK(min[0] == 0.0f && max[1] == 22.0f);
    CHECK(scene_camera_make(&s, 64, 48, &camera) == TYN_OK);
    CHECK_NEAR(camera.forward[2], -1.0f, 1e-6);
    scene_free(&s);
    TEST("vectors that only point somewhere may have any length");
    CHECK(scene_load(&s,
                     files_text("case.scene", FIRST IMAGE BACK "camera position 1 2 3 target 1 2 1e25 up 0 1e30 0 fov_y 50 "
                                                               "near 1 far 9\n"),
                     &error) == 0);
    CHECK(scene_camera_make(&s, 64, 48, &camera) == TYN_OK);
    CHECK_NEAR(camera.forward[2], 1.0f, 1e-6);
    scene_free(&s);
    CHECK(scene_load(&s,
                     files_text("case.scene", FIRST IMAGE BACK "camera position 0 0 0 target 1e-30 0 0 up 0 1e-30 0 fov_y 50 "
                                                               "near 1 far 9\n"),
                     &error) == 0);
    CHECK(scene_camera_make(&s, 64, 48, &camera) == TYN_OK);
    CHECK_NEAR(camera.forward[0], 1.0f, 1e-6);
    scene_free(&s);
}

static void test_nul(void)
{
    static const char lines[] = HEAD "ambient 1\0 1 1\n";
    tool_error error;
    scene s;
    TEST("a NUL byte is an error at its line");
    CHECK(scene_load(&s, files_write("case.scene", lines, sizeof lines - 1), &error) == -1);
    CHECK(strstr(error.text, "case.scene:5: ") != NULL);
    CHECK(scene_load(&s, "build/tmp/no such scene", &error) == -1);
    CHECK(strstr(error.text, "no such scene: can't be read") != NULL);
    CHECK(scene_load(&s, "build", &error) == -1);
    CHECK(strstr(error.text, "folder") != NULL);
}

static void test_long_lines(void)
{
    size_t size = 3000000;
    char *lines = malloc(size + 1);
    tool_error error;
    scene s;
    TEST("lines and tokens of any length");
    if (!lines)
        abort();
    memset(lines, ' ', size);
    memcpy(lines, HEAD "ambient", sizeof HEAD "ambient" - 1);
    memcpy(lines + size - 6, "1 1 1\n", 6);
    CHECK(scene_load(&s, files_write("case.scene", lines, size), &error) == 0);
    CHECK(s.ambient[2] == 1.0f);
    scene_free(&s);
    memset(lines + sizeof HEAD - 1, 'x', size - sizeof HEAD + 1);
    CHECK(scene_load(&s, files_write("case.scene", lines, size), &error) == -1);
    CHECK(strstr(error.text, "case.scene:5: 'xxxxx") != NULL && strlen(error.text) < 300);
    memset(lines + sizeof HEAD - 1, '9', size - sizeof HEAD + 1);
    memcpy(lines + sizeof HEAD - 1, "ambient 1 1 0.", 14);
    CHECK(scene_load(&s, files_write("case.scene", lines, size), &error) == 0);
    CHECK(s.ambient[2] == 1.0f);
    scene_free(&s);
    free(lines);
}

static void test_counts(void)
{
    char lines[8192] = HEAD;
    tool_error error;
    scene s;
    TEST("more media and lights than the library takes are an error, not a crash");
    for (int i = 0; i < 9; i++)
        sprintf(lines + strlen(lines), "medium scatter 1 1 1 phase hg 0.%d\n", i);
    CHECK(scene_load(&s, files_text("case.scene", lines), &error) == -1);
    CHECK(strstr(error.text, ":13: 'medium'") != NULL);
    strcpy(lines, HEAD);
    for (int i = 0; i < 17; i++)
        strcat(lines, SUN "\n");
    CHECK(scene_load(&s, files_text("case.scene", lines), &error) == -1);
    CHECK(strstr(error.text, ":21: 'light'") != NULL);
}

/* The tool's own number parser against the C library's. */
static void test_numbers(void)
{
    static const char *const texts[] = {"0",
                                        "-0",
                                        "1",
                                        "16777217",
                                        "33554435",
                                        "0.1",
                                        "1e-45",
                                        "1e-46",
                                        "3.4e38",
                                        "3.5e38",
                                        "nan",
                                        "inf",
                                        ".",
                                        "-",
                                        "+.5",
                                        "5.",
                                        "1e",
                                        "0x",
                                        "0x1p-3",
                                        "1_0",
                                        "--1",
                                        "9007199254740993",
                                        "0.000000000000000000000000000000000001",
                                        "8388608.5",
                                        "8388609.5",
                                        "1.00000005960464477539",
                                        "16777216.9999999",
                                        "1.17549431e-38"};
    char lines[64];
    int wrong = 0;
    TEST("numbers are what strtof reads");
    for (int i = 0; i < 200000; i++) {
        char *end;
        float expected, got = 0.0f;
        token t = {lines, 0};
        int finite, fixed = (int)(sizeof texts / sizeof *texts);
        if (i < fixed)
            strcpy(lines, texts[i]);
        else if (i % 2)
            sprintf(lines, "%.*f", (int)(test_random() % 12), (double)test_random_float(-1000.0f, 1000.0f));
        else /* next to the middle between two floats */
            sprintf(lines, "%.*f", (int)(test_random() % 9), (double)(float)(test_random() % 40000000) + 0.5);
        t.length = strlen(lines);
        expected = strtof(lines, &end);
        finite = *end == '\0' && end != lines && isfinite(expected);
        if (token_number(t, &got) != finite || (finite && memcmp(&got, &expected, sizeof got) != 0)) {
            printf("  %s\n", lines);
            wrong++;
        }
    }
    CHECK(wrong == 0);
}

void test_scene(void)
{
    files_text("ok.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    files_text("ok.ppm", "P3 1 1 255 1 2 3\n");
    TEST("each rule of the scene format");
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        check_case(&cases[i], "scene");
    test_values();
    test_nul();
    test_long_lines();
    test_counts();
    test_numbers();
    files_remove();
}
