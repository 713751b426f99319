/* test_obj.c - OBJ, MTL and their pictures. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "files.h"
#include "parse.h"
#include "test.h"

#define HEAD                                                                                                                   \
    "tyndall-scene 1\nimage 64 48\ncamera position 0 1 5 target 0 1 0 fov_y 50 near 0.1 far 100\nbackground 0.1 0.2 0.3\n"
#define THREE "v 0 0 0\nv 1 0 0\nv 0 1 0\n"

typedef struct obj_case {
    const char *obj, *mtl;
    const char *place, *says; /* "file:line: 'token" in the message; NULL: a right file */
} obj_case;

static const obj_case obj_cases[] = {
    {THREE "f 1 2 3\n", "", NULL, ""},
    {THREE "f -3 -2 -1\n", "", NULL, ""},
    {THREE "vt 0 0\nvt 1 1 0\nvn 0 0 1\nf 1/1 2/2 3/-1\nf 1//1 2//1 3//1\nf 1/1/1 2/2/-1 -1/2/1\n", "", NULL, ""},
    {"f 1 2 3\n" THREE, "", NULL, ""}, /* what it names comes later */
    {"o x\ng y\ns off\nl 1 2\np 1\nvp 0\n" THREE "f 1 2 3 # face\n#f 9 9 9\n\nf 1 2 \\\n3\n", "", NULL, ""},
    {"v 0 0 0 1\nv 1 0 0 0.5 0.5 0.5\nv 0 1 0 1 1 1 1\r\nf 1 2 3\r\n", "", NULL, ""},
    {"", "", NULL, ""},
    {THREE "f 1 2\n", "", "m.obj:4: 'f'", "three corners"},
    {THREE "f 1 2 4\n", "", "m.obj:4: '4'", "out of range"},
    {THREE "f 1 2 0\n", "", "m.obj:4: '0'", "out of range"},
    {THREE "f 1 2 -4\n", "", "m.obj:4: '-4'", "out of range"},
    {THREE "f 1 2 99999999999999999999\n", "", "m.obj:4: '99999999999999999999'", "out of range"},
    {THREE "f 1 2 3.5\n", "", "m.obj:4: '3.5'", "corner"},
    {THREE "f 1 2 x\n", "", "m.obj:4: 'x'", "corner"},
    {THREE "f 1/ 2/ 3/\n", "", "m.obj:4: '1/'", "corner"},
    {THREE "f 1// 2// 3//\n", "", "m.obj:4: '1//'", "corner"},
    {THREE "vt 0 0\nf 1/1/1/1 2 3\n", "", "m.obj:5: '1/1/1/1'", ""},
    {THREE "f 1/1 2/1 3/1\n", "", "m.obj:4: '1'", "0 vt"},
    {THREE "f 1//2 2 3\n", "", "m.obj:4: '2'", "0 vn"},
    {THREE "f +1 2 3\n", "", "m.obj:4: '+1'", "corner"},
    {"v 0 0\n", "", "m.obj:1: 'v'", "3 numbers"},
    {"v 0 0 nan\n", "", "m.obj:1: 'nan'", "finite"},
    {"v 0 0 1e99\n", "", "m.obj:1: '1e99'", "finite"},
    {"v 0 0 0 1 1 1 1 1\n", "", "m.obj:1: '1'", "too many"},
    {"vt\n", "", "m.obj:1: 'vt'", "number"},
    {"vt a\n", "", "m.obj:1: 'a'", "finite"},
    {"vn 0 0\n", "", "m.obj:1: 'vn'", "3 numbers"},
    {"usemtl\n", "", "m.obj:1: 'usemtl'", "name"},
    {"\nusemtl stone\n" THREE "f 1 2 3\n", "", "m.obj:2: 'stone'", "unknown"},
    {"mtllib m.mtl\nusemtl stone\n", "newmtl Stone\n", "m.obj:2: 'stone'", "unknown"},
    {"mtllib\n", "", "m.obj:1: 'mtllib'", "name"},
    {"mtllib none.mtl\n", "", "m.obj:1: 'none.mtl'", "can't be read"},
    {"mtllib m.mtl none.mtl\n", "", "m.obj:1: 'none.mtl'", "can't be read"},
    {"usemtl my stone # 1\nmtllib m.mtl\n" THREE "f 1 2 3\n", "newmtl my stone # 1\n", NULL, ""},
    {"mtllib m.mtl\n", "newmtl a\nKd 0 0.5 1\nKa 9 9 9\nNs x\nillum 2\nmap_Bump none\nd 1\nd -halo 0.3\n", NULL, ""},
    {"mtllib m.mtl\n", "newmtl\n", "m.mtl:1: 'newmtl'", "name"},
    {"mtllib m.mtl\n", "Kd 1 1 1\n", "m.mtl:1: 'Kd'", "newmtl"},
    {"mtllib m.mtl\n", "newmtl a\nKd 1 1\n", "m.mtl:2: 'Kd'", "missing"},
    {"mtllib m.mtl\n", "newmtl a\nKd 1 1 1 1\n", "m.mtl:2: '1'", "too many"},
    {"mtllib m.mtl\n", "newmtl a\nKd 1 1 1.5\n", "m.mtl:2: '1.5'", "0 to 1"},
    {"mtllib m.mtl\n", "newmtl a\nKd 1 1 -0.5\n", "m.mtl:2: '-0.5'", "0 to 1"},
    {"mtllib m.mtl\n", "newmtl a\nKd 1 x 1\n", "m.mtl:2: 'x'", "finite"},
    {"mtllib m.mtl\n", "newmtl a\nd\n", "m.mtl:2: 'd'", "missing"},
    {"mtllib m.mtl\n", "newmtl a\nd inf\n", "m.mtl:2: 'inf'", "finite"},
    {"mtllib m.mtl\n", "newmtl a\nmap_Kd\n", "m.mtl:2: 'map_Kd'", "name"},
    {"mtllib m.mtl\n", "newmtl a\nmap_Kd none.ppm\n", "m.mtl:2: 'none.ppm'", "can't be read"},
    {"mtllib m.mtl\n", "newmtl a\nmap_Kd k.pgm\n", "k.pgm:1: 'P2'", "not a PPM"},
    {"mtllib m.mtl\n", "newmtl a\nmap_d t.ppm\n", "t.ppm:1: 'P3'", "not a PGM"},
    {"mtllib m.mtl\n", "newmtl a\nmap_Kd -s 2 2 t.ppm\n", "m.mtl:2: '-s", "options"},
};

static void check_case(const obj_case *c)
{
    tool_error error;
    scene s;
    int result, good;
    files_text("m.obj", c->obj);
    files_text("m.mtl", c->mtl);
    result = scene_load(&s, files_text("case.scene", HEAD "mesh m.obj\n"), &error);
    good = !c->place ? result == 0
                     : result == -1 && strstr(error.text, c->place) && strstr(error.text, c->says) &&
                           strstr(error.text, "case.scene:5: 'm.obj': ");
    if (!good)
        printf("  \"%s\" \"%s\" gave: %s\n", c->obj, c->mtl, result == 0 ? "no error" : error.text);
    CHECK(good);
    scene_free(&s);
}

static int load(scene *s, const char *obj, const char *mtl)
{
    tool_error error;
    int result;
    files_text("m.obj", obj);
    files_text("m.mtl", mtl);
    result = scene_load(s, files_text("case.scene", HEAD "mesh m.obj albedo 0.25 0.5 0.75\n"), &error);
    if (result != 0)
        printf("  %s\n", error.text);
    return result;
}

static void test_faces(void)
{
    scene s;
    TEST("faces are fanned and vertices shared");
    CHECK(load(&s, "v 0 0 0\nv 1 0 0\nv 2 1 0\nv 1 2 0\nv 0 1 0\nf 1 2 3 4 5\nf 1 3 5\n", "") == 0);
    CHECK(s.mesh_count == 1 && s.meshes[0].vertices == 5 && s.meshes[0].triangles == 4);
    static const uint32_t fan[] = {0, 1, 2, 0, 2, 3, 0, 3, 4, 0, 2, 4};
    CHECK(s.mesh_count == 1 && memcmp(s.meshes[0].indices, fan, sizeof fan) == 0);
    scene_free(&s);

    TEST("a vertex with two vt is two vertices");
    CHECK(load(&s, "mtllib m.mtl\nusemtl a\n" THREE "vt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\nf 1/2 2/2 3/3\n",
               "newmtl a\nmap_Kd t.ppm\n") == 0);
    CHECK(s.mesh_count == 1 && s.meshes[0].vertices == 4 && s.meshes[0].texcoords[2] == 1.0f);
    scene_free(&s);
}

static void test_materials(void)
{
    const char *faces = "mtllib m.mtl\n" THREE "vt 0 0\nf 1/1 2/1 3/1\nusemtl a\nf 1/1 2/1 3/1\nf 1/1 2/1 3\n";
    scene s;
    TEST("Kd and map_Kd are multiplied, map_Kd alone stands for itself, neither means albedo");
    CHECK(load(&s, faces, "newmtl a\nKd 0.1 0.2 0.3\nmap_Kd t.ppm\nmap_d k.pgm\n") == 0);
    CHECK(s.mesh_count == 3 && s.image_count == 2);
    if (s.mesh_count == 3) {
        CHECK(s.meshes[0].material.albedo[2] == 0.75f && !s.meshes[0].material.texture && !s.meshes[0].texcoords);
        CHECK(s.meshes[1].material.albedo[2] == 0.3f && s.meshes[1].material.texture && s.meshes[1].material.mask);
        CHECK(s.meshes[2].material.albedo[2] == 0.3f && !s.meshes[2].material.texture && !s.meshes[2].material.mask);
    }
    scene_free(&s);
    CHECK(load(&s, faces, "newmtl a\nmap_Kd t.ppm\n") == 0);
    if (s.mesh_count == 3) {
        CHECK(s.meshes[1].material.albedo[2] == 1.0f && s.meshes[1].material.texture);
        CHECK(s.meshes[2].material.albedo[2] == 0.75f && !s.meshes[2].material.texture);
    }
    scene_free(&s);
    CHECK(load(&s, faces, "newmtl a\nmap_d k.pgm\n") == 0);
    CHECK(s.mesh_count == 3 && s.meshes[1].material.albedo[2] == 0.75f && s.meshes[1].material.mask);
    scene_free(&s);

    TEST("d below 0.5 leaves faces out");
    CHECK(load(&s, faces, "newmtl a\nd 0.49\n") == 0);
    CHECK(s.mesh_count == 1);
    scene_free(&s);
    CHECK(load(&s, faces, "newmtl a\nd 0.5\n") == 0);
    CHECK(s.mesh_count == 3);
    scene_free(&s);

    TEST("a picture is read once");
    CHECK(load(&s, "mtllib m.mtl\nmtllib m.mtl\n", "newmtl a\nmap_Kd t.ppm\nnewmtl b\nmap_Kd t.ppm\n") == 0);
    CHECK(s.image_count == 1);
    scene_free(&s);
}

/* Many of everything, so that each array has grown. */
static void test_many(void)
{
    size_t room = 4000000, used = 0;
    char *obj = malloc(room), *mtl = malloc(room);
    scene s;
    TEST("many vertices, materials and corners");
    for (int i = 0; i < 20000; i++)
        used += (size_t)snprintf(obj + used, room - used, "v %d %d.5 -%d\n", i, i % 7, i % 13);
    used += (size_t)snprintf(obj + used, room - used, "mtllib m.mtl\nf");
    for (int i = 0; i < 20000; i++)
        used += (size_t)snprintf(obj + used, room - used, " %d", i + 1);
    used += (size_t)snprintf(obj + used, room - used, "\n");
    size_t mtl_used = 0;
    for (int i = 0; i < 5000; i++) {
        used += (size_t)snprintf(obj + used, room - used, "usemtl m%d\nf %d 2 1\n", i, i + 3);
        mtl_used += (size_t)snprintf(mtl + mtl_used, room - mtl_used, "newmtl m%d\nKd 0 0 1\n", i);
    }
    CHECK(load(&s, obj, mtl) == 0);
    CHECK(s.mesh_count == 5001 && s.meshes[0].vertices == 20000 && s.meshes[0].triangles == 19998);
    CHECK(s.mesh_count == 5001 && s.meshes[5000].positions[0] == 5001.0f);
    scene_free(&s);
    free(obj);
    free(mtl);
}

void test_obj(void)
{
    files_text("t.ppm", "P3 1 1 255 1 2 3\n");
    files_text("k.pgm", "P2 1 1 255 1\n");
    TEST("each rule for OBJ and MTL");
    for (size_t i = 0; i < sizeof obj_cases / sizeof *obj_cases; i++)
        check_case(&obj_cases[i]);
    test_faces();
    test_materials();
    test_many();
    files_remove();
}
