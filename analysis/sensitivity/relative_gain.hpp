#pragma once

#include <Eigen/Core>

namespace mpm {

/// Returns the relative gains of a square process at one frequency (Bristol 1966; section 4.3.1),
///
///   Lambda = G o (G^-1)^T,
///
/// with an entry-by-entry product. Entry (i, j) is the effect of MV j on CV i with all other loops open,
/// divided by its effect with all other CVs held perfectly. Rows and columns sum to 1; diagonal entries far
/// from 1 show strong interaction.
///
/// | symbol | name   | meaning                               | shape | unit |
/// |--------|--------|---------------------------------------|-------|------|
/// | G      | `G`    | frequency response, or static gain    | n x n | any  |
/// | Lambda | result | independent of the units of G         | n x n | -    |
///
/// Every entry is NaN if G is singular, because then the MVs cannot hold all CVs.
/// @throws InputError unless G is square, not empty and finite
Eigen::MatrixXcd relative_gains(const Eigen::Ref<const Eigen::MatrixXcd>& G);

/// Returns the RPN weight function at one frequency (4.16): the largest singular value of S0 T0, S0 = I - T0.
/// Its maximum over the frequencies lies near the frequencies at which the controller works.
/// @throws InputError unless T0 is square, not empty and finite
double rpn_weight(const Eigen::Ref<const Eigen::MatrixXcd>& T0);

}  // namespace mpm
