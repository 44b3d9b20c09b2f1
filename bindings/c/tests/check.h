/* What tests check with: a condition, or why a call was refused. The first that is not so ends
   the program. */
#include "pliant.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define CHECK(condition)                                                                           \
    do {                                                                                           \
        if (!(condition)) {                                                                        \
            fprintf(stderr, "%s:%d: not so: %s\n", __FILE__, __LINE__, #condition);                \
            exit(1);                                                                               \
        }                                                                                          \
    } while (0)

static inline void refused(pliant_status status, const pliant_error *error, pliant_status expected,
                    const char *words) {
    if (status != expected || error->status != expected || !strstr(error->message, words)) {
        fprintf(stderr, "%d, not %d; said: %s; not: %s\n", status, expected, error->message, words);
        exit(1);
    }
}
