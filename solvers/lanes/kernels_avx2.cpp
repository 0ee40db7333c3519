#define MPM_KERNELS kAvx2Kernels
#define MPM_KERNELS_NAME "avx2"
#include "solvers/lanes/kernels.inc"
