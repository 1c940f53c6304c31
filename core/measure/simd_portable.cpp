#define TRIMTAB_KERNELS portable
#include "simd_all.h"
