#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "results/archive/hdf5_file.hpp"
#include "results/archive/variable_text.hpp"

namespace mpm {

/// Writes matrices of one shape as one variable (matrix, row, column), or (row, column) for a single one
/// without a dimension of its own. An empty matrix is written as NaN: `rows` and `cols` are the lengths of
/// the last two dimensions.
void write_matrices(Hdf5Group& group, const std::vector<std::string>& dimensions, const VariableText& text,
                    const std::vector<const Eigen::MatrixXd*>& matrices, Eigen::Index rows,
                    Eigen::Index cols);

/// The reverse of write_matrices(); every matrix gets its numbers. `stacked`: the variable has a dimension
/// along the matrices.
void read_matrices(const Hdf5Group& group, const std::string& name, bool stacked,
                   const std::vector<Eigen::MatrixXd*>& matrices, Eigen::Index rows, Eigen::Index cols);

/// The same for vectors: (vector, element), or (element) for a single one without a dimension of its own.
void write_vectors(Hdf5Group& group, const std::vector<std::string>& dimensions, const VariableText& text,
                   const std::vector<const Eigen::VectorXd*>& vectors, Eigen::Index size);

/// The reverse of write_vectors(). `stacked`: the variable has a dimension along the vectors.
std::vector<Eigen::VectorXd> read_vectors(const Hdf5Group& group, const std::string& name, bool stacked,
                                          std::size_t count, Eigen::Index size);

}  // namespace mpm
