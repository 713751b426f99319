/* tree.c - see tree.h */
#include "tree.h"

#include "base.h"

static void widen(tyni_node *node, uint16_t low, uint16_t high)
{
    node->low = low < node->low ? low : node->low;
    node->high = high > node->high ? high : node->high;
}

void tyni_tree_build(tyni_tree *tree, tyni_node *nodes, const tyni_row *row)
{
    int32_t used = 0, count = row->columns, level;
    tree->nodes = nodes;
    tree->levels = 0;
    for (level = TYNI_TREE_FIRST; level < TYNI_TREE_LEVELS && count >> level; level++) {
        int32_t size = (count + (1 << level) - 1) >> level, children = level == TYNI_TREE_FIRST ? 1 << level : 2;
        int32_t below = level == TYNI_TREE_FIRST ? count : used - tree->start[level - 1];
        tree->start[level] = used;
        tree->levels = level;
        for (int32_t k = 0; k < size; k++) {
            tyni_node *node = &nodes[used + k];
            int32_t end = tyni_mini((k + 1) * children, below);
            node->low = 65535;
            node->high = 0;
            for (int32_t i = k * children; i < end; i++) {
                if (level == TYNI_TREE_FIRST)
                    widen(node, row->threshold[i], row->threshold[i]);
                else
                    widen(node, nodes[tree->start[level - 1] + i].low, nodes[tree->start[level - 1] + i].high);
            }
        }
        used += size;
    }
}
