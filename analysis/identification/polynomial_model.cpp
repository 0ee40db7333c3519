#include "analysis/identification/polynomial_model.hpp"

#include <algorithm>
#include <cstddef>

#include <fmt/format.h>

#include "analysis/statistics/signal_check.hpp"
#include "base/error.hpp"

namespace mpm {
namespace {

Eigen::VectorXd one() {
  return Eigen::VectorXd::Ones(1);
}

void require_polynomial(const std::string& name, const Eigen::VectorXd& polynomial, bool monic) {
  if (polynomial.size() == 0)
    throw InputError("polynomial " + name, "no coefficient", "1 or more");
  if (!polynomial.allFinite())
    throw InputError("polynomial " + name, "a coefficient that is not finite", "finite values only");
  if (monic && polynomial(0) != 1.0)
    throw InputError("first coefficient of " + name, fmt::format("{}", polynomial(0)), "1");
}

void require_inputs(const PolynomialModel& model, const Eigen::Ref<const Eigen::MatrixXd>& u) {
  if (u.rows() != static_cast<Eigen::Index>(model.inputs.size()))
    throw InputError("rows of u", fmt::format("{}", u.rows()), fmt::format("{}", model.inputs.size()));
  if (!u.allFinite())
    throw InputError("u", "a value that is not finite", "finite values only");
}

void require_length(const std::string& name, Eigen::Index found, Eigen::Index N) {
  if (found != N)
    throw InputError("length of " + name, fmt::format("{} samples", found), fmt::format("{}, that of u", N));
}

/// sum_j B_j/F_j u_j.
Eigen::VectorXd input_part(const PolynomialModel& model, const Eigen::Ref<const Eigen::MatrixXd>& u,
                           StartState start) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(u.cols());
  for (std::size_t j = 0; j < model.inputs.size(); ++j) {
    const InputPath& path = model.inputs[j];
    const Eigen::VectorXd input = u.row(static_cast<Eigen::Index>(j)).transpose();
    sum += filter(path.B, path.F, input, path.delay, start);
  }
  return sum;
}

/// Takes coefficients from a list, front to back.
class Reader {
 public:
  explicit Reader(const Eigen::Ref<const Eigen::VectorXd>& values) : values_(values) {}

  Eigen::VectorXd take(Eigen::Index count) {
    Eigen::VectorXd taken = values_.segment(next_, count);
    next_ += count;
    return taken;
  }
  Eigen::VectorXd take_monic(Eigen::Index degree) {
    Eigen::VectorXd polynomial(degree + 1);
    polynomial << 1.0, take(degree);
    return polynomial;
  }

 private:
  Eigen::VectorXd values_;
  Eigen::Index next_ = 0;
};

}  // namespace

ModelOrder PolynomialModel::order() const {
  ModelOrder order{A.size() - 1, {}, C.size() - 1, D.size() - 1};
  for (const InputPath& path : inputs)
    order.inputs.push_back({path.B.size(), path.F.size() - 1, path.delay});
  return order;
}

Eigen::VectorXd PolynomialModel::parameters() const {
  Eigen::VectorXd all(order().parameter_count());
  Eigen::Index next = 0;
  const auto append = [&all, &next](const auto& coefficients) {
    all.segment(next, coefficients.size()) = coefficients;
    next += coefficients.size();
  };
  append(A.tail(A.size() - 1));
  for (const InputPath& path : inputs) {
    append(path.B);
    append(path.F.tail(path.F.size() - 1));
  }
  append(C.tail(C.size() - 1));
  append(D.tail(D.size() - 1));
  return all;
}

void PolynomialModel::validate() const {
  require_polynomial("A", A, true);
  require_polynomial("C", C, true);
  require_polynomial("D", D, true);
  for (std::size_t j = 0; j < inputs.size(); ++j) {
    require_polynomial(fmt::format("B of input {}", j), inputs[j].B, false);
    require_polynomial(fmt::format("F of input {}", j), inputs[j].F, true);
  }
  order().validate(static_cast<Eigen::Index>(inputs.size()));
}

PolynomialModel model_from_parameters(const ModelOrder& order,
                                      const Eigen::Ref<const Eigen::VectorXd>& parameters) {
  order.validate(static_cast<Eigen::Index>(order.inputs.size()));
  if (parameters.size() != order.parameter_count())
    throw InputError("parameters of a model", fmt::format("{}", parameters.size()),
                     fmt::format("{} ({})", order.parameter_count(), order.to_string()));
  Reader reader(parameters);
  PolynomialModel model;
  model.A = reader.take_monic(order.na);
  for (const PathOrder& path : order.inputs) {
    InputPath made;
    made.B = reader.take(path.nb);
    made.F = reader.take_monic(path.nf);
    made.delay = path.delay;
    model.inputs.push_back(made);
  }
  model.C = reader.take_monic(order.nc);
  model.D = reader.take_monic(order.nd);
  return model;
}

Eigen::VectorXd simulate(const PolynomialModel& model, const Eigen::Ref<const Eigen::MatrixXd>& u,
                         StartState start) {
  model.validate();
  require_inputs(model, u);
  return filter(one(), model.A, input_part(model, u, start), 0, start);
}

Eigen::VectorXd prediction_errors(const PolynomialModel& model, const Eigen::Ref<const Eigen::VectorXd>& y,
                                  const Eigen::Ref<const Eigen::MatrixXd>& u, StartState start) {
  model.validate();
  require_inputs(model, u);
  require_length("y", y.size(), u.cols());
  require_signal("y", y, 0);
  const Eigen::VectorXd v = filter(model.A, one(), y, 0, start) - input_part(model, u, start);
  return filter(model.D, model.C, v, 0, start);
}

Eigen::MatrixXd step_response(const PolynomialModel& model, Eigen::Index samples) {
  model.validate();
  if (samples < 1)
    throw InputError("samples of a step response", fmt::format("{}", samples), "1 or more");
  // The step comes at sample 0, and column 0 is sample 1.
  const Eigen::VectorXd step = Eigen::VectorXd::Ones(samples + 1);
  Eigen::MatrixXd response(model.inputs.size(), samples);
  for (std::size_t j = 0; j < model.inputs.size(); ++j) {
    const InputPath& path = model.inputs[j];
    const Eigen::VectorXd output = filter(one(), model.A, filter(path.B, path.F, step, path.delay));
    response.row(static_cast<Eigen::Index>(j)) = output.tail(samples).transpose();
  }
  return response;
}

}  // namespace mpm
