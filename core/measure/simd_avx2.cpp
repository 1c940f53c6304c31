#define TRIMTAB_KERNELS avx2
#include "simd_all.h"
