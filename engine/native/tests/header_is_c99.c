/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * The header compiles as C99, and the library says that it was built from it. */
#include "photon_maps.h"

int main(void) { return pm_abi_version() == PM_ABI_VERSION ? 0 : 1; }
