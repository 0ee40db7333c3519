#include "results/archive/matrix_io.hpp"

#include <algorithm>
#include <cassert>

#include "base/non_finite.hpp"
#include "base/row_major.hpp"

namespace mpm {
namespace {

/// The shape in the file.
std::vector<std::size_t> shape_of(bool stacked, std::size_t count, std::initializer_list<Eigen::Index> rest) {
  std::vector<std::size_t> shape;
  if (stacked)
    shape.push_back(count);
  for (const Eigen::Index length : rest)
    shape.push_back(static_cast<std::size_t>(length));
  return shape;
}

}  // namespace

void write_matrices(Hdf5Group& group, const std::vector<std::string>& dimensions, const VariableText& text,
                    const std::vector<const Eigen::MatrixXd*>& matrices, Eigen::Index rows,
                    Eigen::Index cols) {
  std::vector<double> values(matrices.size() * static_cast<std::size_t>(rows * cols), kNaN);
  double* place = values.data();
  for (const Eigen::MatrixXd* matrix : matrices) {
    assert(matrix->size() == 0 || (matrix->rows() == rows && matrix->cols() == cols));
    if (matrix->size() > 0)
      Eigen::Map<RowMajorMatrix>(place, rows, cols) = *matrix;
    place += rows * cols;
  }
  group.write(text.name, dimensions, values, attributes<double>(text));
}

void read_matrices(const Hdf5Group& group, const std::string& name, bool stacked,
                   const std::vector<Eigen::MatrixXd*>& matrices, Eigen::Index rows, Eigen::Index cols) {
  const std::vector<double> values =
      group.read<double>(name, shape_of(stacked, matrices.size(), {rows, cols}));
  const double* place = values.data();
  for (Eigen::MatrixXd* matrix : matrices) {
    *matrix = Eigen::Map<const RowMajorMatrix>(place, rows, cols);
    place += rows * cols;
  }
}

void write_vectors(Hdf5Group& group, const std::vector<std::string>& dimensions, const VariableText& text,
                   const std::vector<const Eigen::VectorXd*>& vectors, Eigen::Index size) {
  std::vector<double> values(vectors.size() * static_cast<std::size_t>(size), kNaN);
  double* place = values.data();
  for (const Eigen::VectorXd* vector : vectors) {
    assert(vector->size() == 0 || vector->size() == size);
    std::copy(vector->begin(), vector->end(), place);
    place += size;
  }
  group.write(text.name, dimensions, values, attributes<double>(text));
}

std::vector<Eigen::VectorXd> read_vectors(const Hdf5Group& group, const std::string& name, bool stacked,
                                          std::size_t count, Eigen::Index size) {
  const std::vector<double> values = group.read<double>(name, shape_of(stacked, count, {size}));
  std::vector<Eigen::VectorXd> vectors;
  vectors.reserve(count);
  for (const double* place = values.data(); vectors.size() < count; place += size)
    vectors.emplace_back(Eigen::Map<const Eigen::VectorXd>(place, size));
  return vectors;
}

}  // namespace mpm
