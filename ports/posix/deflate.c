/* deflate.c - LZ77 with hash chains over 32 KB, lazy by one byte; each block with Huffman codes of its own, or with the fixed
 * ones where those are shorter. */
#include "deflate.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#define WINDOW 32768
#define HASH_SIZE 32768
#define CHAIN 8       /* candidates per position: more costs time, and wins little */
#define GOOD_MATCH 64 /* long enough: not searched further, and no lazy look */
#define MATCH_MIN 6   /* dithered pictures have short matches everywhere, dearer than their literals */
#define MATCH_MAX 258
#define BLOCK_TOKENS 32768
#define LITERALS 286
#define DISTANCES 30
#define LENGTH_CODES 19
#define OUT_BYTES 32768

typedef struct deflater {
    deflate_sink sink;
    void *context;
    int failed;
    unsigned char out[OUT_BYTES];
    size_t out_used;
    uint64_t bits; /* not yet whole bytes, from the low end */
    int bit_count;
    /* A token is a literal (distance 0) or a match. */
    uint16_t token_length[BLOCK_TOKENS], token_distance[BLOCK_TOKENS];
    size_t tokens;
    uint32_t literal_use[LITERALS], distance_use[DISTANCES];
    size_t head[HASH_SIZE], previous[WINDOW]; /* position + 1; 0: none */
} deflater;

static const uint16_t length_base[29] = {3,  4,  5,  6,  7,  8,  9,  10, 11,  13,  15,  17,  19,  23, 27,
                                         31, 35, 43, 51, 59, 67, 83, 99, 115, 131, 163, 195, 227, 258};
static const uint8_t length_extra[29] = {0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3, 4, 4, 4, 4, 5, 5, 5, 5, 0};
static const uint16_t distance_base[30] = {1,    2,    3,    4,    5,    7,    9,    13,    17,    25,
                                           33,   49,   65,   97,   129,  193,  257,  385,   513,   769,
                                           1025, 1537, 2049, 3073, 4097, 6145, 8193, 12289, 16385, 24577};
static const uint8_t distance_extra[30] = {0, 0, 0, 0, 1, 1, 2, 2,  3,  3,  4,  4,  5,  5,  6,
                                           6, 7, 7, 8, 8, 9, 9, 10, 10, 11, 11, 12, 12, 13, 13};

static void flush_bytes(deflater *d)
{
    if (d->out_used && !d->failed)
        d->failed = d->sink(d->context, d->out, d->out_used) != 0;
    d->out_used = 0;
}

/* At most 32 bits. */
static void put(deflater *d, uint32_t value, int count)
{
    d->bits |= (uint64_t)value << d->bit_count;
    d->bit_count += count;
    while (d->bit_count >= 8) {
        d->out[d->out_used++] = (unsigned char)d->bits;
        d->bits >>= 8;
        d->bit_count -= 8;
        if (d->out_used == OUT_BYTES)
            flush_bytes(d);
    }
}

static int length_code(int length)
{
    int code = 28;
    while (length < length_base[code])
        code--;
    return code;
}

static int distance_code(int distance)
{
    int low = 0, high = 29;
    while (low < high) {
        int middle = (low + high + 1) / 2;
        if (distance >= distance_base[middle])
            low = middle;
        else
            high = middle - 1;
    }
    return low;
}

/* ---- Huffman codes ---------------------------------------------------------------------------------------------------- */

/* Both of one width: gcc 12 for AArch64 walks bytes and words by one counter in assign(), and then takes it for a function that
 * writes nothing. */
typedef struct code {
    uint16_t length[LITERALS + 2]; /* 0: unused */
    uint16_t bits[LITERALS + 2];   /* reversed, as they are written */
} code;

/* The deepest leaf of the Huffman tree over `use`; lengths go to c. */
static int tree_lengths(const uint32_t *use, int count, code *c)
{
    uint64_t weight[2 * LITERALS];
    int parent[2 * LITERALS], active[LITERALS], live = 0, nodes = count, deepest = 0;
    for (int i = 0; i < count; i++) {
        weight[i] = use[i];
        c->length[i] = 0;
        if (use[i])
            active[live++] = i;
    }
    /* A decoder wants a complete code: even one symbol alone needs a bit, and a second one beside it does no harm. */
    for (int i = 0; live < 2; i++)
        if (!use[i]) {
            weight[i] = 0;
            active[live++] = i;
        }
    int leaves[LITERALS], leaf_count = live;
    memcpy(leaves, active, sizeof leaves);
    while (live > 1) {
        for (int pick = 0; pick < 2; pick++) { /* the two lightest to the end of the list */
            int least = 0;
            for (int i = 1; i < live - pick; i++)
                if (weight[active[i]] < weight[active[least]])
                    least = i;
            int last = live - 1 - pick, t = active[last];
            active[last] = active[least];
            active[least] = t;
        }
        int a = active[live - 1], b = active[live - 2];
        weight[nodes] = weight[a] + weight[b];
        parent[a] = parent[b] = nodes;
        active[live - 2] = nodes++;
        live--;
    }
    for (int i = 0; i < leaf_count; i++) {
        int depth = 0;
        for (int n = leaves[i]; n != nodes - 1; n = parent[n])
            depth++;
        c->length[leaves[i]] = (uint16_t)depth;
        deepest = depth > deepest ? depth : deepest;
    }
    return deepest;
}

/* Code words in the order that RFC 1951 gives for the lengths. */
static void assign(code *c, int count)
{
    uint32_t next[17] = {0}, used[16] = {0};
    for (int i = 0; i < count; i++)
        used[c->length[i]]++;
    used[0] = 0;
    for (int l = 1; l < 16; l++)
        next[l + 1] = (next[l] + used[l]) << 1;
    for (int i = 0; i < count; i++) {
        uint32_t word = next[c->length[i]]++, reversed = 0;
        for (int b = 0; b < c->length[i]; b++)
            reversed |= (word >> b & 1) << (c->length[i] - 1 - b);
        c->bits[i] = (uint16_t)reversed;
    }
}

/* Halving the weights flattens a tree that is too deep; all equal it is at most 9 deep. */
static void make_code(const uint32_t *use, int count, int limit, code *c)
{
    uint32_t weights[LITERALS];
    memcpy(weights, use, (size_t)count * sizeof *weights);
    memset(c, 0, sizeof *c);
    while (tree_lengths(weights, count, c) > limit)
        for (int i = 0; i < count; i++)
            weights[i] = (weights[i] + 1) / 2;
    assign(c, count);
}

static void fixed_codes(code *literals, code *distances)
{
    memset(literals, 0, sizeof *literals);
    memset(distances, 0, sizeof *distances);
    for (int i = 0; i < 288; i++)
        literals->length[i] = i < 144 ? 8 : i < 256 ? 9 : i < 280 ? 7 : 8;
    for (int i = 0; i < 30; i++)
        distances->length[i] = 5;
    assign(literals, 288);
    assign(distances, 30);
}

/* ---- blocks ----------------------------------------------------------------------------------------------------------- */

static uint64_t body_bits(const deflater *d, const code *literals, const code *distances)
{
    uint64_t bits = 0;
    for (int i = 0; i < LITERALS; i++)
        bits += (uint64_t)d->literal_use[i] * (literals->length[i] + (i > 256 ? length_extra[i - 257] : 0u));
    for (int i = 0; i < DISTANCES; i++)
        bits += (uint64_t)d->distance_use[i] * ((uint64_t)distances->length[i] + distance_extra[i]);
    return bits;
}

/* The lengths of both codes as runs: symbols 0 .. 15 are lengths, 16 repeats the one before, 17 and 18 are zeros. */
typedef struct runs {
    uint8_t symbol[LITERALS + DISTANCES], extra[LITERALS + DISTANCES];
    int count, literals, distances;
    uint32_t use[LENGTH_CODES];
} runs;

static void add_run(runs *r, int symbol, int extra)
{
    r->symbol[r->count] = (uint8_t)symbol;
    r->extra[r->count++] = (uint8_t)extra;
    r->use[symbol]++;
}

static void make_runs(const code *literals, const code *distances, runs *r)
{
    uint16_t all[LITERALS + DISTANCES];
    int total;
    memset(r, 0, sizeof *r);
    for (r->literals = LITERALS; r->literals > 257 && !literals->length[r->literals - 1];)
        r->literals--;
    for (r->distances = DISTANCES; r->distances > 1 && !distances->length[r->distances - 1];)
        r->distances--;
    memcpy(all, literals->length, (size_t)r->literals * sizeof *all);
    memcpy(all + r->literals, distances->length, (size_t)r->distances * sizeof *all);
    total = r->literals + r->distances;
    for (int i = 0; i < total;) {
        int same = 1;
        while (i + same < total && all[i + same] == all[i] && same < 138)
            same++;
        if (all[i] == 0 && same >= 11) {
            add_run(r, 18, same - 11);
        } else if (all[i] == 0 && same >= 3) {
            add_run(r, 17, same - 3);
        } else if (all[i] != 0 && same >= 4) {
            same = same > 7 ? 7 : same;
            add_run(r, all[i], 0);
            add_run(r, 16, same - 4);
        } else {
            add_run(r, all[i], 0);
            same = 1;
        }
        i += same;
    }
}

static int run_bits(int symbol)
{
    return symbol == 16 ? 2 : symbol == 17 ? 3 : symbol == 18 ? 7 : 0;
}

static void put_body(deflater *d, const code *literals, const code *distances)
{
    for (size_t i = 0; i < d->tokens; i++) {
        int length = d->token_length[i], distance = d->token_distance[i];
        if (distance == 0) {
            put(d, literals->bits[length], literals->length[length]);
            continue;
        }
        int lc = length_code(length), dc = distance_code(distance);
        put(d, literals->bits[257 + lc], literals->length[257 + lc]);
        put(d, (uint32_t)(length - length_base[lc]), length_extra[lc]);
        put(d, distances->bits[dc], distances->length[dc]);
        put(d, (uint32_t)(distance - distance_base[dc]), distance_extra[dc]);
    }
    put(d, literals->bits[256], literals->length[256]);
}

static void put_block(deflater *d, int last)
{
    static const uint8_t order[LENGTH_CODES] = {16, 17, 18, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2, 14, 1, 15};
    code literals, distances, lengths;
    runs r;
    int sent = LENGTH_CODES;
    uint64_t own, fixed;
    d->literal_use[256] = 1;
    make_code(d->literal_use, LITERALS, 15, &literals);
    make_code(d->distance_use, DISTANCES, 15, &distances);
    make_runs(&literals, &distances, &r);
    make_code(r.use, LENGTH_CODES, 7, &lengths);
    while (sent > 4 && !lengths.length[order[sent - 1]])
        sent--;
    own = 14 + 3 * (uint64_t)sent + body_bits(d, &literals, &distances);
    for (int i = 0; i < r.count; i++)
        own += lengths.length[r.symbol[i]] + (uint64_t)run_bits(r.symbol[i]);
    {
        code fixed_literals, fixed_distances;
        fixed_codes(&fixed_literals, &fixed_distances);
        fixed = body_bits(d, &fixed_literals, &fixed_distances);
        put(d, (uint32_t)last, 1);
        put(d, fixed <= own ? 1 : 2, 2);
        if (fixed <= own) {
            put_body(d, &fixed_literals, &fixed_distances);
        } else {
            put(d, (uint32_t)r.literals - 257, 5);
            put(d, (uint32_t)r.distances - 1, 5);
            put(d, (uint32_t)sent - 4, 4);
            for (int i = 0; i < sent; i++)
                put(d, lengths.length[order[i]], 3);
            for (int i = 0; i < r.count; i++) {
                put(d, lengths.bits[r.symbol[i]], lengths.length[r.symbol[i]]);
                put(d, r.extra[i], run_bits(r.symbol[i]));
            }
            put_body(d, &literals, &distances);
        }
    }
    d->tokens = 0;
    memset(d->literal_use, 0, sizeof d->literal_use);
    memset(d->distance_use, 0, sizeof d->distance_use);
}

/* ---- matches ---------------------------------------------------------------------------------------------------------- */

static void add_token(deflater *d, int length, int distance)
{
    d->token_length[d->tokens] = (uint16_t)length;
    d->token_distance[d->tokens++] = (uint16_t)distance;
    if (distance) {
        d->literal_use[257 + length_code(length)]++;
        d->distance_use[distance_code(distance)]++;
    } else {
        d->literal_use[length]++;
    }
    if (d->tokens == BLOCK_TOKENS)
        put_block(d, 0);
}

static uint32_t hash_at(const unsigned char *p)
{
    uint32_t v = 0;
    for (int i = 0; i < MATCH_MIN; i++)
        v = v * 16777619u + p[i] + 1;
    return (v ^ v >> 15) % HASH_SIZE;
}

/* Enters position `at` and gives the longest earlier match there; 0: none. */
static int find(deflater *d, const unsigned char *data, size_t size, size_t at, int *distance)
{
    int best = MATCH_MIN - 1, most = size - at < MATCH_MAX ? (int)(size - at) : MATCH_MAX;
    uint32_t h;
    size_t candidate;
    if (most < MATCH_MIN)
        return 0;
    h = hash_at(data + at);
    candidate = d->head[h];
    d->previous[at % WINDOW] = candidate;
    d->head[h] = at + 1;
    for (int tries = 0; candidate && tries < CHAIN; tries++) {
        size_t p = candidate - 1;
        if (at - p > WINDOW - 1) /* its entry in `previous` may be a newer one's */
            break;
        if (data[p + (size_t)best] == data[at + (size_t)best]) {
            int length = 0;
            while (length < most && data[p + (size_t)length] == data[at + (size_t)length])
                length++;
            if (length > best) {
                best = length;
                *distance = (int)(at - p);
                if (best == most || best >= GOOD_MATCH)
                    break;
            }
        }
        candidate = d->previous[p % WINDOW];
    }
    return best >= MATCH_MIN ? best : 0;
}

static void compress(deflater *d, const unsigned char *data, size_t size)
{
    int held = 0, held_distance = 0; /* the match at the position before, waiting for a better one here */
    for (size_t at = 0; at < size;) {
        int distance = 0, length = find(d, data, size, at, &distance);
        if (held && held >= length) {
            int unused;
            size_t end = at - 1 + (size_t)held;
            add_token(d, held, held_distance);
            for (at++; at < end; at++)
                find(d, data, size, at, &unused);
            held = 0;
            continue;
        }
        if (held)
            add_token(d, data[at - 1], 0);
        held = 0;
        if (length >= MATCH_MIN) {
            held = length;
            held_distance = distance;
        } else {
            add_token(d, data[at], 0);
        }
        at++;
    }
    if (held) { /* can't be: a match at the last byte is too short; kept for safety */
        add_token(d, data[size - 1], 0);
    }
}

static uint32_t adler32(const unsigned char *data, size_t size)
{
    uint32_t a = 1, b = 0;
    while (size) {
        size_t n = size < 5552 ? size : 5552; /* the most that can't overflow b */
        for (size_t i = 0; i < n; i++) {
            a += data[i];
            b += a;
        }
        a %= 65521;
        b %= 65521;
        data += n;
        size -= n;
    }
    return b << 16 | a;
}

int deflate_zlib(const unsigned char *data, size_t size, deflate_sink sink, void *context)
{
    deflater *d = calloc(1, sizeof *d);
    uint32_t sum = adler32(data, size);
    int result;
    if (!d)
        return -1;
    d->sink = sink;
    d->context = context;
    put(d, 0x9c78, 16); /* deflate, 32 KB, default level */
    compress(d, data, size);
    put_block(d, 1);
    if (d->bit_count)
        put(d, 0, 8 - d->bit_count);
    for (int i = 3; i >= 0; i--)
        put(d, sum >> 8 * i & 255, 8);
    flush_bytes(d);
    result = d->failed ? -1 : 0;
    free(d);
    return result;
}
