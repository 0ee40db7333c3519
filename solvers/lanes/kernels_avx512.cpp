#define MPM_KERNELS kAvx512Kernels
#define MPM_KERNELS_NAME "avx512"
#include "solvers/lanes/kernels.inc"
