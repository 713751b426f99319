/* sweep.c - see sweep.h */
#include "sweep.h"

#include "base.h"

/* The least rank whose ray is dark in a column: position >= threshold; `samples` if none is. Positions are about even, so the
 * guess is off by one at most. */
static int32_t rank_of(const tyni_sweep *s, uint32_t threshold)
{
    int32_t n = s->samples, k = (int32_t)((float)threshold * ((float)(n - 1) / 65534.0f));
    k = tyni_clampi(k, 0, n);
    while (k < n && s->position[k] < threshold)
        k++;
    while (k > 0 && s->position[k - 1] >= threshold)
        k--;
    return k;
}

void tyni_sweep_begin(tyni_sweep *s, const tyni_row *row, const tyni_slice *slice)
{
    uint32_t total = 0;
    s->first = slice->first;
    s->last = slice->last;
    s->samples = slice->last - slice->first + 1;
    s->falling = row->p_scale * slice->dp < 0.0f;
    s->at = 0;
    memset(s->bits, 0xff, sizeof *s->bits * tyni_sweep_words((size_t)row->columns));
    for (int32_t k = 0; k < s->samples; k++) {
        float p = tyni_slice_p(slice, s->falling ? s->last - k : s->first + k);
        s->position[k] = (uint16_t)tyni_row_position(row, p);
    }
    /* count, sum up to the ends of the buckets, and fill each from its end */
    memset(s->heads, 0, sizeof *s->heads * (size_t)(s->samples + 1));
    for (int32_t c = 0; c < row->columns; c++)
        s->heads[rank_of(s, row->threshold[c])]++;
    for (int32_t k = 0; k <= s->samples; k++)
        s->heads[k] = total += s->heads[k];
    for (int32_t c = row->columns - 1; c >= 0; c--) {
        int32_t k = rank_of(s, row->threshold[c]);
        s->heads[k]--;
        if (k < s->samples)
            s->order[s->heads[k]] = (uint32_t)c;
    }
}

void tyni_sweep_to(tyni_sweep *s, int32_t sample)
{
    uint32_t to = s->heads[(s->falling ? s->last - sample : sample - s->first) + 1];
    for (; s->at < to; s->at++)
        s->bits[s->order[s->at] >> 5] &= ~(1u << (s->order[s->at] & 31u));
    for (; s->at > to; s->at--)
        s->bits[s->order[s->at - 1] >> 5] |= 1u << (s->order[s->at - 1] & 31u);
}
