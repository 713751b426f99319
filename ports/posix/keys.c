/* keys.c */
#include "keys.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static int check_range(text *t, token at, float x, key_range r)
{
    static const char *const words[] = {"",
                                        "must be 0 or more",
                                        "must be from 0 to 1",
                                        "must be above 0",
                                        "must be between 0 and 180",
                                        "must be between 0 and 170"};
    int good = 1;
    switch (r) {
    case ANY:
        break;
    case NOT_NEGATIVE:
        good = x >= 0.0f;
        break;
    case UNIT:
        good = x >= 0.0f && x <= 1.0f;
        break;
    case POSITIVE:
        good = x > 0.0f;
        break;
    case BELOW_180:
        good = x > 0.0f && x < 180.0f;
        break;
    case BELOW_170:
        good = x > 0.0f && x < 170.0f;
        break;
    }
    return good ? 0 : text_fail(t, at, "%s", words[r]);
}

int keys_numbers(text *t, token of, int count, key_range r, float *out)
{
    for (int i = 0; i < count; i++) {
        text ahead = *t;
        token number;
        text_token(&ahead, &number);
        if (text_number(t, of, &out[i]) != 0 || check_range(t, number, out[i], r) != 0)
            return -1;
    }
    return 0;
}

/* isotropic, rayleigh or hg G */
static int read_phase(text *t, key *k)
{
    if (!text_token(t, &k->word))
        return text_fail(t, k->at, "a phase function is missing after it");
    if (token_is(k->word, "isotropic") || token_is(k->word, "rayleigh"))
        return 0;
    if (!token_is(k->word, "hg"))
        return text_fail(t, k->word, "is no phase function (isotropic, rayleigh, hg G)");
    text ahead = *t;
    token number;
    text_token(&ahead, &number);
    if (text_number(t, k->word, k->numbers) != 0)
        return -1;
    if (!(k->numbers[0] > -1.0f && k->numbers[0] < 1.0f))
        return text_fail(t, number, "G must be between -1 and 1");
    return 0;
}

int keys_read(text *t, token directive, key *keys, size_t count)
{
    token word;
    while (text_token(t, &word)) {
        key *k = NULL;
        for (size_t i = 0; i < count; i++)
            if (token_is(word, keys[i].name))
                k = &keys[i];
        if (!k)
            return text_fail(t, word, "unknown key, or a token too many");
        if (k->seen)
            return text_fail(t, word, "given twice");
        k->seen = 1;
        k->at = word;
        if (k->kind == NUMBERS && keys_numbers(t, word, k->count, k->range, k->numbers) != 0)
            return -1;
        if (k->kind == FILE_NAME && !text_token(t, &k->word))
            return text_fail(t, word, "a file name is missing after it");
        if (k->kind == WORD && !text_token(t, &k->word))
            return text_fail(t, word, "a word is missing after it");
        if (k->kind == PHASE && read_phase(t, k) != 0)
            return -1;
    }
    for (size_t i = 0; i < count; i++)
        if (keys[i].required && !keys[i].seen)
            return text_fail(t, directive, "missing key '%s'", keys[i].name);
    return 0;
}

double vector_length(const double v[3])
{
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

void vector_difference(const float a[3], const float b[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = (double)a[i] - (double)b[i];
}

int vector_is_zero(const float v[3])
{
    return v[0] == 0.0f && v[1] == 0.0f && v[2] == 0.0f;
}

/* Beyond rounding: parallel within a ten thousandth of a degree. */
int vector_parallel(const double a[3], const float b[3])
{
    double c[3], wide[3] = {(double)b[0], (double)b[1], (double)b[2]};
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        c[i] = a[j] * wide[k] - a[k] * wide[j];
    }
    return vector_length(c) <= 1e-6 * vector_length(a) * vector_length(wide);
}

int keys_word(text *t, const key *k, const char *const *words)
{
    char list[128] = "";
    size_t n = 0;
    for (int i = 0; words[i]; i++) {
        if (token_is(k->word, words[i]))
            return i;
        n += (size_t)snprintf(list + n, sizeof list - n, "%s%s", i ? ", " : "", words[i]); /* the lists are short */
    }
    return text_fail(t, k->word, "is not one of %s", list);
}

/* By elimination; what is left of a singular matrix after rounding does not count as a pivot. */
int matrix_is_invertible(const float m[16])
{
    double a[4][4];
    for (int r = 0; r < 4; r++) {
        double most = 0.0;
        for (int c = 0; c < 4; c++)
            most = fabs((double)m[4 * r + c]) > most ? fabs((double)m[4 * r + c]) : most;
        for (int c = 0; c < 4; c++)
            a[r][c] = most > 0.0 ? (double)m[4 * r + c] / most : 0.0;
    }
    for (int k = 0; k < 4; k++) {
        int best = k;
        for (int r = k + 1; r < 4; r++)
            best = fabs(a[r][k]) > fabs(a[best][k]) ? r : best;
        if (!(fabs(a[best][k]) > 1e-14))
            return 0;
        for (int c = 0; c < 4; c++) {
            double swapped = a[k][c];
            a[k][c] = a[best][c];
            a[best][c] = swapped;
        }
        for (int r = k + 1; r < 4; r++) {
            double factor = a[r][k] / a[k][k];
            for (int c = k; c < 4; c++)
                a[r][c] -= factor * a[k][c];
        }
    }
    return 1;
}
