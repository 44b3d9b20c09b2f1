/* When do many pairs meet? Single pairs without a world, for programs with a search of their own.

     cc -std=c11 -O2 batch.c $(pkg-config --cflags --libs pliant) -o batch
     ./batch */
#include <pliant.h>

#include <stdio.h>
#include <stdlib.h>

enum { PAIRS = 100000 };

/* A vertex and a triangle: 4 points, at the start and at the end. */
typedef struct {
    double start[4][3], end[4][3];
} pair;

int main(void) {
    pair *pairs = malloc(PAIRS * sizeof *pairs);
    uint8_t *hit = malloc(PAIRS);
    double *low = malloc(PAIRS * sizeof *low), *high = malloc(PAIRS * sizeof *high);
    if (!pairs || !hit || !low || !high) {
        return 1;
    }
    uint32_t state = 1;
    double *numbers = (double *)pairs;
    for (size_t i = 0; i < PAIRS * sizeof(pair) / sizeof(double); i++) {
        state = state * 1664525 + 1013904223;
        numbers[i] = (state >> 8) / 16777216.0;
    }

    /* Corners lie where they are: point k of all pairs is a column with a stride. */
    pliant_points start[4], end[4];
    for (int corner = 0; corner < 4; corner++) {
        start[corner] = (pliant_points){pairs[0].start[corner], PAIRS, sizeof(pair),
                                        sizeof(double), PLIANT_F64};
        end[corner] = start[corner];
        end[corner].data = pairs[0].end[corner];
    }
    pliant_error error;
    if (pliant_vertex_triangle_impacts(start, end, 1e-6, hit, low, high, &error)) {
        fprintf(stderr, "%s\n", error.message);
        return 1;
    }
    int count = 0, first = -1;
    for (int place = 0; place < PAIRS; place++) {
        if (hit[place]) {
            count++;
            first = first < 0 || high[place] < high[first] ? place : first;
        }
    }
    printf("%d of %d pairs meet", count, PAIRS);
    if (first >= 0) {
        printf("; pair %d first, after %.6f and by %.6f", first, low[first], high[first]);
    }
    printf("\n");
    free(pairs);
    free(hit);
    free(low);
    free(high);
    return 0;
}
