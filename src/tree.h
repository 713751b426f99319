/* tree.h - a 1D min/max binary tree over a row's thresholds (IVB section 6.4; Chen et al. 2011).
 *
 * A node of level l holds the least and the greatest threshold of 2^l columns. A ray is lit in all of them if its position is
 * below the least, dark in all if it is not below the greatest. Thresholds are what the columns themselves are compared with,
 * to the bit, and every texel that the slice touches is a column: so the tree is conservative with nothing to round outwards,
 * and what it finds is what a march over the columns finds. As in IVB's own code the lowest levels are left out: a node of two
 * columns costs as much to read as the columns. */
#ifndef TYNI_TREE_H
#define TYNI_TREE_H

#include "row.h"

#include "base.h"

#define TYNI_TREE_FIRST 2   /* lowest level that is kept */
#define TYNI_TREE_LEVELS 19 /* TYN_MAX_MAPS maps of TYN_MAX_SHADOW texels are 2^18 columns and a few */

typedef struct tyni_node {
    uint16_t low, high;
} tyni_node;

typedef struct tyni_tree {
    tyni_node *nodes;
    int32_t start[TYNI_TREE_LEVELS]; /* of a level's nodes */
    int32_t levels;                  /* the highest level; 0: the row is too short for a tree */
} tyni_tree;

/* Nodes for a row of so many columns. */
static inline size_t tyni_tree_room(size_t columns)
{
    return columns / 2 + TYNI_TREE_LEVELS; /* columns / 4 + columns / 8 + ..., each rounded up */
}

/* Builds it into `nodes`, room as above. */
void tyni_tree_build(tyni_tree *tree, tyni_node *nodes, const tyni_row *row);

/* The node of columns index << level and on. */
static inline const tyni_node *tyni_tree_node(const tyni_tree *tree, int32_t level, int32_t index)
{
    return &tree->nodes[tree->start[level] + index];
}

/* IVB's Algorithm 2, one turn of it: the span of 2^level columns from column i on that is found all lit or all dark. Climbs a
 * level where the place is aligned for it, then descends; `level` is that of the span before, 0 at first. As printed, the test
 * of a single sample stands inside the loop over levels and is skipped on level 0; here it follows the loop. `top`: the highest
 * level looked at. Returns how many nodes were. */
static inline int32_t tyni_tree_span(const tyni_tree *tree, const uint16_t *threshold, uint32_t position, int32_t i,
                                     int32_t *level, int32_t *top, int *lit)
{
    int32_t up = *level ? *level + 1 : TYNI_TREE_FIRST, l = *level, looked = 0;
    if (up <= tree->levels && !(i & ((1 << up) - 1)))
        l = up;
    for (*top = l; l >= TYNI_TREE_FIRST; l--) {
        const tyni_node *node = tyni_tree_node(tree, l, i >> l);
        looked++;
        *lit = position < node->low;
        if (*lit || position >= node->high)
            break;
    }
    if (l < TYNI_TREE_FIRST) {
        l = 0; /* what lies between the tree and the columns is not kept */
        looked++;
        *lit = position < threshold[i];
    }
    *level = l;
    return looked;
}

#endif
