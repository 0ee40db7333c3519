#pragma once

namespace mpm {

/// One or two columns of the rows, as the kernels see them. The eight numbers of a block in the column
/// `partner` are those that the block before it has, or would have, in `column`.
struct RowTap {
  long offset;
  int column;
  int partner;
};

/// Runs of `blocks` blocks of eight rows, whose columns are windows of series: the eight numbers of block k
/// of run r in the column of a tap begin at numbers[starts[r] + 8 k + offset], and are those of the rows from
/// rows[r] + 8 k on. Every row is summed in the order of the taps, the column before its partner.
struct RowWindows {
  const double* numbers;
  const RowTap* taps;
  long pair_count;  ///< number of taps that have a partner; they come first
  long tap_count;
  long blocks;
  const long* starts;
  const long* rows;
  long run_count;
};

/// Springs of a family (LimitSprings) as the kernels see them: padded vectors of 8 `blocks` numbers.
struct SpringArrays {
  long blocks;
  const double *stiffness, *lower, *upper, *step, *value;
  double* force;
  unsigned char* stretched;  ///< one bit a row (force != 0), eight rows a byte
};

/// The parts of a residual that come from the limits of rows or variables: vectors of `count` numbers, not
/// padded. A `slack` widens both limits; null: there is none.
struct LimitArrays {
  long count;
  const double *value, *lower, *upper, *dual, *slack;
};

/// Slacks s with the costs q s^2 + c s, and the sum of what pushes each: vectors of `count` numbers, not
/// padded.
struct SlackArrays {
  long count;
  const double *slack, *quadratic, *linear, *pull;
};

/// The inner loops of the active-set method, of its certificate, and of fits to long records. They work on
/// eight numbers side by side in an order that is the same for every instruction set, without fused
/// operations: the bits of the result do not depend on the processor.
///
/// All pointers are multiples of 64 bytes, but for those of LimitArrays, SlackArrays, RowWindows,
/// `below_zero` and `non_zero`, and the `out` of A x. Strides are multiples of 8. Padding is zero unless
/// stated otherwise (LaneVector). A matrix with a `stride` has its columns (rows, in `rows`) that far apart.
struct LaneKernels {
  const char* name;  ///< "baseline", "avx2", "avx512"
  bool (*runs_here)();

  /// out = A x in the existing rows.
  void (*multiply)(const RowWindows& rows, const double* x, double* out);
  /// out = A x, for blocks of eight rows, each stored column by column; its columns belong to the listed
  /// numbers of x.
  void (*multiply_some)(const double* blocks, const int* list, long columns, long block_count,
                        const double* x, double* out);
  /// out += M x, M of `columns` columns.
  void (*add_product)(const double* matrix, long stride, long columns, const double* x, double* out);
  /// out += sum over the listed rows i of factor_i a_i.
  void (*add_rows)(const double* rows, long stride, const int* list, long count, const double* factor,
                   double* out);
  /// M += sum over the listed rows of weight_k a_k a_k' in the lower triangle; the numbers above it are
  /// arbitrary. `scratch`: kOuterRows * stride numbers. The matrix has `matrix_stride` >= stride.
  void (*add_outer)(const double* rows, long stride, const int* list, long count, const double* weight,
                    double* scratch, double* matrix, long matrix_stride);
  static constexpr long kOuterRows = 32;

  /// S = L L' from the lower triangle of S, of `size` rows, a multiple of 8. L is written below its diagonal;
  /// the other numbers of the blocks on the diagonal are zero, and the inverses of these blocks go to
  /// `inverse` (see invert). Returns false if a pivot is not above `smallest` times its diagonal in S.
  bool (*factor)(const double* matrix, long stride, long size, double smallest, double* lower,
                 double* inverse);
  /// The inverse of each block of eight on the diagonal of L, column by column and then again row by row,
  /// kInverse * size numbers in all. `reciprocal`: reciprocals of the diagonal of L.
  void (*invert)(const double* lower, long stride, long size, const double* reciprocal, double* inverse);
  static constexpr long kInverse = 16;
  /// inv(L) x and inv(L') x in place, for `size` numbers.
  void (*solve_lower)(const double* lower, long stride, long size, const double* inverse, double* x);
  void (*solve_upper)(const double* lower, long stride, long size, const double* inverse, double* x);

  double (*dot)(const double* a, const double* b, long size);  ///< `size` a multiple of 8

  /// Eight filters side by side, B/(1 + a_1 q^-1 + ...), with eight numbers for each sample and for each
  /// coefficient; denominators[0..7] are not read. `nb` - 1 samples before x and `na` before y are read.
  void (*filter_eight)(const double* numerators, long nb, const double* denominators, long na,
                       const double* x, long samples, double* y);
  /// Filters eight signals x at once, from rest: x/F1, path = B x/F1, and out = B x/(F1 F2) or, without
  /// `second`, out = x/F1. Polynomials of `order` + 1 coefficients, `order` from 1 to kPathOrder.
  void (*filter_paths)(const double* first, const double* numerators, const double* second, long order,
                       const double* x, long samples, double* path, double* out);
  static constexpr long kPathOrder = 8;
  /// sums[8 (lags s + l) + i] = sum over k of a[8 k + i] b[8 (k - l) + s], for s < `signals` <= 8 and
  /// l < `lags`: the products of eight signals with each of some signals before. `lags` - 1 samples before b
  /// are read.
  void (*lag_products)(const double* a, const double* b, long samples, long signals, long lags, double* sums);
  /// sums[8 l + i] = sum over k of a[8 k + i] b[8 (k - l) + i]; b may be at any address.
  void (*lane_products)(const double* a, const double* b, long samples, long lags, double* sums);

  /// y(k) = sum over l < `nh` of h(l) x(k - l), in that order, for `samples` samples, a multiple of 8. h and
  /// x may be at any addresses; x is zero, and read, up to kConvolutionBefore samples before its first.
  void (*convolve)(const double* h, long nh, const double* x, long samples, double* y);
  static constexpr long kConvolutionBefore = 32;

  void (*pull)(const SpringArrays& springs);            ///< LimitSprings::pull
  void (*pull_stretched)(const SpringArrays& springs);  ///< LimitSprings::pull_stretched
  void (*pull_within)(const SpringArrays& springs);     ///< after a step to v on which no spring changes
  long (*find_changing)(const SpringArrays& springs, int* rows);  ///< LimitSprings::find_changing
  double (*curvature)(const SpringArrays& springs);               ///< of the stretched springs along `step`

  /// The largest distance of a value beyond its limits, at least 0.
  double (*violation)(const LimitArrays& limits);
  /// The first row whose value is furthest beyond its limits, if that is more than `most`, which is then
  /// updated; -1 when there is none.
  long (*most_violated)(const LimitArrays& limits, double* most);
  /// The largest |dual| times distance to its limit: the upper limit of a positive, the lower one of a
  /// negative dual. Nothing may push at an absent limit: there it is |dual|.
  double (*complementarity)(const LimitArrays& limits);
  /// True when lower <= upper, lower < inf and upper > -inf everywhere; false with a NaN.
  bool (*ordered)(const double* lower, const double* upper, long count);
  bool (*finite)(const double* values, long count);        ///< no NaN and no infinity
  double (*below_zero)(const double* values, long count);  ///< the largest -value, at least 0
  /// The places of the numbers that are not zero, in order, and their count.
  long (*non_zero)(const double* values, long count, int* places);
  /// The multiplier of s >= 0 is 2 q s + c - |pull|. Returns the largest of two errors: how far a multiplier
  /// is below zero, and |multiplier s|.
  double (*slack_residual)(const SlackArrays& slacks);
  double (*slack_cost)(const SlackArrays& slacks);  ///< sum of s (q s + c)
};

}  // namespace mpm
