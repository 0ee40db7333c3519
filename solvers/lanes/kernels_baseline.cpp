#define MPM_KERNELS kBaselineKernels
#define MPM_KERNELS_NAME "baseline"
#include "solvers/lanes/kernels.inc"
