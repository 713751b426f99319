/* compare.c - tyndall compare A.pfm B.pfm: how far A is from B, the truth. */
#include "commands.h"
#include "pfm.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int check(const pfm *image, const char *path)
{
    size_t row = (size_t)image->width * (size_t)image->channels, count = row * (size_t)image->height;
    for (size_t i = 0; i < count; i++)
        if (!isfinite(image->values[i])) {
            error_say("%s: not a finite number at x %lu y %lu channel %lu", path,
                      (unsigned long)(i % row / (size_t)image->channels), (unsigned long)(i / row),
                      (unsigned long)(i % (size_t)image->channels));
            return -1;
        }
    return 0;
}

static void print_errors(const pfm *a, const pfm *b)
{
    size_t channels = (size_t)a->channels, row = (size_t)a->width * channels, count = row * (size_t)a->height, at = 0;
    double sum = 0.0, truth = 0.0, squares = 0.0, worst = 0.0, peak = 0.0, rmse;
    for (size_t y = 0; y < count; y += row) { /* row by row: partial sums keep their digits in large images */
        double row_sum = 0.0, row_truth = 0.0, row_squares = 0.0;
        for (size_t i = y; i < y + row; i++) {
            double error = fabs((double)a->values[i] - (double)b->values[i]);
            row_sum += error;
            row_truth += fabs((double)b->values[i]);
            row_squares += error * error;
            peak = (double)b->values[i] > peak ? (double)b->values[i] : peak;
            if (error > worst) {
                worst = error;
                at = i;
            }
        }
        sum += row_sum;
        truth += row_truth;
        squares += row_squares;
    }
    rmse = sqrt(squares / (double)count);
    printf("relative_l1 %.9g\n", sum > 0.0 ? sum / truth : 0.0); /* inf where the truth is black */
    printf("rmse %.9g\n", rmse);
    printf("psnr_db %.6g\n", rmse > 0.0 ? 20.0 * log10(peak / rmse) : (double)INFINITY);
    printf("max_error %.9g\n", worst);
    printf("max_at %lu %lu %lu\n", (unsigned long)(at % row / channels), (unsigned long)(at / row),
           (unsigned long)(at % channels));
}

int command_compare(int argc, char **argv)
{
    pfm images[2] = {{0, 0, 0, NULL}, {0, 0, 0, NULL}};
    tool_error error;
    int status = 0;
    if (argc == 1 && strcmp(argv[0], "--help") == 0) {
        printf(
            "usage: tyndall compare A.pfm B.pfm\n\n"
            "Prints the relative L1 difference (sum |A - B| / sum |B|; B is the truth), the RMSE, the PSNR (its peak is the\n"
            "largest value of B), the largest difference and where it is: x y channel, y from the top.\n");
        return 0;
    }
    if (argc != 2) {
        error_say("usage: tyndall compare A.pfm B.pfm");
        return 2;
    }
    for (int i = 0; i < 2 && status == 0; i++) {
        if (pfm_load(&images[i], argv[i], &error) != 0) {
            error_report(&error, argv[i]);
            status = 1;
        } else if (check(&images[i], argv[i]) != 0) {
            status = 1;
        }
    }
    if (status == 0 && (images[0].width != images[1].width || images[0].height != images[1].height ||
                        images[0].channels != images[1].channels)) {
        error_say("%s is %ldx%ld with %ld channels, %s is %ldx%ld with %ld", argv[0], (long)images[0].width,
                  (long)images[0].height, (long)images[0].channels, argv[1], (long)images[1].width, (long)images[1].height,
                  (long)images[1].channels);
        status = 1;
    }
    if (status == 0)
        print_errors(&images[0], &images[1]);
    free(images[0].values);
    free(images[1].values);
    return status;
}
