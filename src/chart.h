/* chart.h - draws a slice's row and its tree, and a ray in them: TYN_DEBUG_ROW and TYN_DEBUG_TREE. */
#ifndef TYNI_CHART_H
#define TYNI_CHART_H

#include "pass.h"

#include "base.h"

/* Over the whole target; after the slices' jobs. Leaves it as it is where there are no slices. */
void tyni_chart_draw(const tyni_pass *pass);

#endif
