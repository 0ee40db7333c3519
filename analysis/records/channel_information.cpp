#include "analysis/records/channel_information.hpp"

#include <cmath>
#include <cstddef>

#include <Eigen/Eigenvalues>

#include "analysis/records/channel_error_fit.hpp"
#include "base/non_finite.hpp"

namespace mpm {
namespace {

/// Least component of a parameter that takes part, in a unit vector of three.
constexpr double kTakesPart = 0.3;

}  // namespace

ChannelInformation channel_information(const Study& study, const AssessedLoop& loop, const Channel& channel,
                                       double share) {
  const ChannelErrorFit fit = ChannelErrorFits(study, share).of(loop, channel.cv);
  std::vector<Eigen::Index> own;
  for (std::size_t i = 0; i < fit.errors.size(); ++i)
    if (fit.errors[i].input == channel.mv)
      own.push_back(static_cast<Eigen::Index>(i));
  const auto parameter = [&](Eigen::Index i) {
    return fit.errors[static_cast<std::size_t>(own[static_cast<std::size_t>(i)])].parameter;
  };
  const Eigen::MatrixXd X = fit.X(Eigen::all, own);
  ChannelInformation told{.parameters = X.cols()};
  const Eigen::MatrixXd information = X.transpose() * X / fit.noise;
  const Eigen::VectorXd sizes = information.diagonal().cwiseSqrt();
  told.rank =
      (Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(information).eigenvalues().array() > 1.0).count();
  if (!(sizes.minCoeff() > 0.0)) {
    told.condition = kInfinity;
    for (Eigen::Index i = 0; i < sizes.size(); ++i)
      if (sizes(i) == 0.0)
        told.alike.push_back(parameter(i));
    return told;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> alike(sizes.cwiseInverse().asDiagonal() * information *
                                                             sizes.cwiseInverse().asDiagonal());
  const double least = alike.eigenvalues()(0);
  told.condition = least > 0.0 ? alike.eigenvalues().tail<1>()(0) / least : kInfinity;
  for (Eigen::Index i = 0; i < sizes.size(); ++i)
    if (std::abs(alike.eigenvectors()(i, 0)) > kTakesPart)
      told.alike.push_back(parameter(i));
  return told;
}

}  // namespace mpm
