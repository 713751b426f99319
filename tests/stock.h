/* stock.h - the small scenes that several tests share: one court, lights all around it, air from clear to thick. */
#ifndef TYN_TEST_STOCK_H
#define TYN_TEST_STOCK_H

#include "model.h"

typedef struct stock {
    const char *name;
    oracle_kind kind;
    double light[3];  /* sun: the way to it as right, up, forward of the camera; spot, point: its position */
    double target[3]; /* spot */
    double angle;     /* spot, degrees */
    double air;       /* scattering of the haze, 1/m */
    int textured;     /* a window of 16 x 16 panes in the light: a slide, a gobo 8 metres wide */
    double pitch;     /* height of the camera's target: 1.8 looks level */
} stock;

extern const stock stock_list[];
extern const int stock_count;

/* By its name; NULL without memory or such a name. */
oracle_scene *stock_new(const char *name, int width, int height);

#endif
