#pragma once

#include <cstddef>
#include <new>
#include <vector>

#include <Eigen/Core>

namespace mpm {

/// Memory for the kernels (LaneKernels): begins at a multiple of 64 bytes.
template <class T>
struct LaneAllocator {
  using value_type = T;
  static constexpr std::align_val_t kAlignment{64};

  LaneAllocator() = default;
  template <class U>
  LaneAllocator(const LaneAllocator<U>& /*other*/) {}

  T* allocate(std::size_t count) { return static_cast<T*>(::operator new(count * sizeof(T), kAlignment)); }
  void deallocate(T* memory, std::size_t /*count*/) { ::operator delete(memory, kAlignment); }
  template <class U>
  bool operator==(const LaneAllocator<U>& /*other*/) const {
    return true;
  }
};

using LaneMemory = std::vector<double, LaneAllocator<double>>;

/// The next multiple of 8.
inline Eigen::Index padded(Eigen::Index size) {
  return (size + 7) / 8 * 8;
}

/// A vector of `size` numbers for the kernels, followed by zeros up to a multiple of eight.
class LaneVector {
 public:
  LaneVector() = default;
  explicit LaneVector(Eigen::Index size)
      : size_(size), memory_(static_cast<std::size_t>(padded(size)), 0.0) {}
  explicit LaneVector(const Eigen::VectorXd& values) : LaneVector(values.size()) { vector() = values; }

  Eigen::Index size() const { return size_; }
  double* data() { return memory_.data(); }
  const double* data() const { return memory_.data(); }
  double& operator()(Eigen::Index i) { return memory_[static_cast<std::size_t>(i)]; }
  double operator()(Eigen::Index i) const { return memory_[static_cast<std::size_t>(i)]; }

  /// The numbers without the padding.
  Eigen::Map<Eigen::VectorXd> vector() { return {data(), size_}; }
  Eigen::Map<const Eigen::VectorXd> vector() const { return {data(), size_}; }

 private:
  Eigen::Index size_ = 0;
  LaneMemory memory_;
};

/// A matrix by columns for the kernels: each column is followed by zeros up to `stride` numbers, a multiple
/// of eight.
class LaneMatrix {
 public:
  /// A matrix of zeros.
  LaneMatrix(Eigen::Index rows, Eigen::Index columns)
      : stride_(padded(rows)), columns_(columns), memory_(static_cast<std::size_t>(stride_ * columns), 0.0) {}

  Eigen::Index stride() const { return stride_; }
  Eigen::Index columns() const { return columns_; }
  double* data() { return memory_.data(); }
  const double* data() const { return memory_.data(); }
  double* column(Eigen::Index j) { return data() + j * stride_; }
  const double* column(Eigen::Index j) const { return data() + j * stride_; }
  double& operator()(Eigen::Index i, Eigen::Index j) { return column(j)[i]; }
  double operator()(Eigen::Index i, Eigen::Index j) const { return column(j)[i]; }

 private:
  Eigen::Index stride_, columns_;
  LaneMemory memory_;
};

}  // namespace mpm
