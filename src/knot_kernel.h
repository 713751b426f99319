/* knot_kernel.h - a template: from positions to z, for fourier.c and lookup.c. */

/* z of a position, 0 .. 65535: piece a goes from the last knot that is not above it, 0 if all are, to the next. */
TYNI_V_INLINE float TYNI_V(fourier_z)(const tyni_fourier *f, const tyni_shelf *s, float position)
{
    const uint32_t q = (uint32_t)tyni_maxf(position, 0.0f), low = v_above16(s->knot, q), high = v_above16(s->knot + 32, q);
    const int32_t a = low ? tyni_ctz32(low) - 1 : high ? 31 + tyni_ctz32(high) : 63;
    const float from = (float)s->knot[a], to = (float)s->knot[a + 1];
    const float part = to > from ? tyni_clampf((position - from) / (to - from), 0.0f, 1.0f) : 0.5f;
    return f->margin + (1.0f - 2.0f * f->margin) / (float)TYNI_FOURIER_KNOTS * ((float)a + part);
}
