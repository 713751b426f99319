/* hostile.c - files made to cost squares of their length: hostile FOLDER. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

static FILE *create(const char *folder, const char *name)
{
    char path[4096];
    FILE *file;
    snprintf(path, sizeof path, "%s/%s", folder, name);
    file = fopen(path, "wb");
    if (!file)
        exit(1);
    return file;
}

/* Pairs v/vt that all have one place in obj.c's hash table: its products, exclusive-ored, are the same. */
static void pairs(FILE *file, int count)
{
    const uint32_t a = 0x9e3779b1u, b = 0x85ebca77u;
    uint32_t inverse = a;
    for (int i = 0; i < 5; i++)
        inverse *= 2 - a * inverse; /* Newton */
    fprintf(file, "v 0 0 0\nvt 0 0\nf");
    for (uint32_t vt = 0; count > 0; vt++) {
        uint32_t v = (vt * b ^ 1) * inverse;
        if (v >= 1999999999)
            continue;
        fprintf(file, " %lu/%lu", (unsigned long)v + 1, (unsigned long)vt + 1);
        count--;
    }
    fprintf(file, "\n");
}

static uint32_t fnv(uint32_t hash, const char *text)
{
    for (; *text; text++)
        hash = (hash ^ (unsigned char)*text) * 16777619u;
    return hash;
}

/* Short names and a very long one that a list by this hash has in one row, the long one first. */
static void names(FILE *file, int length, int count)
{
    uint32_t hash = 2166136261u, row;
    char name[16] = "";
    for (int i = 0; i < length; i++)
        hash = fnv(hash, "a");
    row = (hash ^ hash >> 16) % 4096;
    for (unsigned i = 0; hash = fnv(2166136261u, name), (hash ^ hash >> 16) % 4096 != row; i++)
        snprintf(name, sizeof name, "%x", i);
    fprintf(file, "v 0 0 0\nusemtl %s\nusemtl ", name);
    for (int i = 0; i < length; i++)
        fputc('a', file);
    for (int i = 0; i < count; i++)
        fprintf(file, "\nusemtl %s", name);
    fprintf(file, "\n");
}

/* One line for each of many names of one file. */
static void aliases(FILE *file, const char *statement, const char *name, int count)
{
    for (int i = 0; i < count; i++) {
        fprintf(file, "%s ", statement);
        for (int k = 0; k < 11; k++)
            fputs(i >> k & 1 ? ".//" : "./", file);
        fprintf(file, "%s\n", name);
    }
}

int main(int argc, char **argv)
{
    FILE *file;
    if (argc != 2)
        return 2;
    file = create(argv[1], "pairs.obj");
    pairs(file, 150000);
    fclose(file);
    file = create(argv[1], "names.obj");
    names(file, 1000000, 300000);
    fclose(file);
    file = create(argv[1], "picture.ppm");
    fprintf(file, "P6\n600 600\n255\n");
    for (int i = 0; i < 3 * 600 * 600; i++)
        fputc(i & 255, file);
    fclose(file);
    file = create(argv[1], "pictures.mtl");
    fprintf(file, "newmtl m\n");
    aliases(file, "map_Kd", "picture.ppm", 2000);
    fclose(file);
    file = create(argv[1], "pictures.obj");
    fprintf(file, "mtllib pictures.mtl\n");
    fclose(file);
    file = create(argv[1], "library.mtl");
    for (int i = 0; i < 30000; i++)
        fprintf(file, "newmtl m\nKd 0 0 0\n");
    fclose(file);
    file = create(argv[1], "libraries.obj");
    aliases(file, "mtllib", "library.mtl", 2000);
    fclose(file);
    return 0;
}
