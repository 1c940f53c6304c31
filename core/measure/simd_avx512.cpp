#define TRIMTAB_KERNELS avx512
#include "simd_all.h"
