#include "bench/perf/octave_file.hpp"

#include <fstream>
#include <iterator>

#include <fmt/format.h>

#include "base/error.hpp"
#include "solvers/qp_solver_factory.hpp"

namespace mpm {
namespace {

void write_matrix(std::ostream& file, const char* name, const Eigen::Ref<const Eigen::MatrixXd>& matrix) {
  fmt::memory_buffer text;
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "# name: {}\n# type: matrix\n# rows: {}\n# columns: {}\n", name, matrix.rows(),
                 matrix.cols());
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    for (Eigen::Index j = 0; j < matrix.cols(); ++j)
      fmt::format_to(out, " {:.17g}", matrix(i, j));
    fmt::format_to(out, "\n");
  }
  file.write(text.data(), static_cast<std::streamsize>(text.size()));
}

// One column a program.
Eigen::MatrixXd stacked(const QpSequence& sequence, Eigen::VectorXd QpData::*member) {
  Eigen::MatrixXd result((sequence.data.front().*member).size(),
                         static_cast<Eigen::Index>(sequence.data.size()));
  for (Eigen::Index k = 0; k < result.cols(); ++k)
    result.col(k) = sequence.data[static_cast<std::size_t>(k)].*member;
  return result;
}

Eigen::MatrixXd answers(const QpSequence& sequence) {
  const auto solver = qp_solver_factory("active-set")(sequence.structure);
  Eigen::MatrixXd x(sequence.structure->variable_count(), static_cast<Eigen::Index>(sequence.data.size()));
  for (Eigen::Index k = 0; k < x.cols(); ++k) {
    const QpResult& result = solver->solve(sequence.data[static_cast<std::size_t>(k)]);
    if (result.status != QpStatus::solved)
      throw InputError(fmt::format("program {} of {}", k, sequence.name()), to_string(result.status).data(),
                       "a program that can be solved");
    x.col(k) = result.x;
  }
  return x;
}

}  // namespace

void write_octave_file(const std::filesystem::path& path, const QpSequence& sequence) {
  if (sequence.data.empty())
    throw InputError(sequence.name(), "no programs", "at least one");
  const QpStructure& structure = *sequence.structure;
  std::ofstream file(path);
  write_matrix(file, "hessian", structure.hessian);
  write_matrix(file, "rows", structure.rows);
  write_matrix(file, "slack_of_row", structure.slack_of_row.cast<double>().array() + 1.0);
  write_matrix(file, "slack_quadratic", structure.slack_quadratic);
  write_matrix(file, "slack_linear", structure.slack_linear);
  write_matrix(file, "gradient", stacked(sequence, &QpData::gradient));
  write_matrix(file, "lower", stacked(sequence, &QpData::lower));
  write_matrix(file, "upper", stacked(sequence, &QpData::upper));
  write_matrix(file, "hard_lower", stacked(sequence, &QpData::hard_lower));
  write_matrix(file, "hard_upper", stacked(sequence, &QpData::hard_upper));
  write_matrix(file, "soft_lower", stacked(sequence, &QpData::soft_lower));
  write_matrix(file, "soft_upper", stacked(sequence, &QpData::soft_upper));
  write_matrix(file, "x", answers(sequence));
  if (!file.flush())
    throw InputError("file to export to", path.string(), "a file that can be written");
}

}  // namespace mpm
