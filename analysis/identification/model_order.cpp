#include "analysis/identification/model_order.hpp"

#include <algorithm>
#include <cstddef>
#include <functional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.hpp"

namespace mpm {
namespace {

void require_at_least(const std::string& name, Eigen::Index value, Eigen::Index lowest) {
  if (value < lowest)
    throw InputError(name, fmt::format("{}", value), fmt::format("{} or more", lowest));
}

/// One number when all inputs share it, else a list.
std::string of_inputs(const ModelOrder& order, Eigen::Index PathOrder::*member) {
  std::vector<Eigen::Index> values;
  for (const PathOrder& path : order.inputs)
    values.push_back(path.*member);
  const bool same = std::adjacent_find(values.begin(), values.end(), std::not_equal_to<>()) == values.end();
  return same && !values.empty() ? fmt::format("{}", values.front()) : fmt::format("{}", values);
}

}  // namespace

Eigen::Index ModelOrder::parameter_count() const {
  Eigen::Index count = na + nc + nd;
  for (const PathOrder& path : inputs)
    count += path.nb + path.nf;
  return count;
}

Eigen::Index ModelOrder::memory() const {
  Eigen::Index longest = na;
  for (const PathOrder& path : inputs)
    longest = std::max(longest, path.delay + path.nb - 1);
  return longest;
}

std::string ModelOrder::to_string() const {
  std::string text = na > 0 ? fmt::format("na {} ", na) : "";
  text += "nb " + of_inputs(*this, &PathOrder::nb);
  const bool rational =
      std::any_of(inputs.begin(), inputs.end(), [](const PathOrder& p) { return p.nf > 0; });
  if (rational)
    text += " nf " + of_inputs(*this, &PathOrder::nf);
  if (nc + nd > 0)
    text += fmt::format(" nc {} nd {}", nc, nd);
  return text + " delay " + of_inputs(*this, &PathOrder::delay);
}

void ModelOrder::validate(Eigen::Index nu) const {
  if (static_cast<Eigen::Index>(inputs.size()) != nu)
    throw InputError("inputs of a model order", fmt::format("{}", inputs.size()), fmt::format("{}", nu));
  require_at_least("order of A", na, 0);
  require_at_least("order of C", nc, 0);
  require_at_least("order of D", nd, 0);
  for (std::size_t j = 0; j < inputs.size(); ++j) {
    require_at_least(fmt::format("coefficients of B of input {}", j), inputs[j].nb, 1);
    require_at_least(fmt::format("order of F of input {}", j), inputs[j].nf, 0);
    require_at_least(fmt::format("delay of input {}", j), inputs[j].delay, 0);
  }
}

ModelOrder output_error_order(Eigen::Index nu, Eigen::Index nb, Eigen::Index nf, Eigen::Index delay) {
  return box_jenkins_order(nu, nb, nf, 0, 0, delay);
}

ModelOrder box_jenkins_order(Eigen::Index nu, Eigen::Index nb, Eigen::Index nf, Eigen::Index nc,
                             Eigen::Index nd, Eigen::Index delay) {
  return {0, std::vector<PathOrder>(static_cast<std::size_t>(nu), {nb, nf, delay}), nc, nd};
}

}  // namespace mpm
