/* config.h - presets, and a config with its zeros filled in. */
#ifndef TYNI_CONFIG_H
#define TYNI_CONFIG_H

#include "base.h"

/* TYN_E_CONFIG for what is outside its range. */
tyn_status tyni_config_fill(tyn_config *config);

#endif
