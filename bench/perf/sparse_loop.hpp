#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "plants/linear/transfer_matrix.hpp"
#include "solvers/mpc.hpp"
#include "solvers/mpc_options.hpp"
#include "solvers/qp.hpp"
#include "solvers/qp_solver.hpp"

namespace mpm {

/// How many CVs and MVs a made-up plant has.
struct PlantSize {
  int cvs, mvs;
  /// "40x15"
  std::string name() const;
};

/// The sizes of the curve in docs/performance.md.
inline constexpr PlantSize kPlantSizes[] = {{7, 3}, {20, 8}, {40, 15}, {80, 30}};

/// A made-up plant with a range controller like that of chapter6 (6.19), (6.20), and a loop of the two:
///
/// | what          | value                                                                              |
/// |---------------|------------------------------------------------------------------------------------|
/// | density       | a CV answers to a quarter of the MVs (to two at least) and to one MD               |
/// | MDs           | a fifth of the number of MVs, at least one                                         |
/// | channel       | first order: gain +-(0.3 to 1.5), time constant 3 to 40 samples (log-uniform),     |
/// |               | dead time 0 to 8 samples                                                           |
/// | horizons      | Hp 60, Hc 10                                                                       |
/// | limits        | MVs hard +-1; CVs soft +-0.5, hard +-4                                             |
/// | weights       | move suppression 25, target 1, slack 100; costs of the MVs +-(1 to 8)              |
/// | noise         | of the CVs, standard deviation 0.01                                                |
/// | disturbances  | every 10 samples a step to +-0.4 at most: in turn an MD, and a signal that is      |
/// |               | added to a CV behind a lag of 15 samples, which the controller cannot see          |
///
/// All of it follows from the size and a seed.
class SparseLoop {
 public:
  SparseLoop(const PlantSize& size, SlackForm slack);

  /// The times of one loop, sample by sample.
  struct Times {
    std::vector<double> step;  ///< microseconds of processor time, the whole step of the controller
    double making = 0.0;       ///< seconds to make the controller
    double targets = 0.0;      ///< seconds of the loop in the solver of (6.19)
    double moves = 0.0;        ///< seconds of the loop in the solver of (6.20)
    double iterations = 0.0;   ///< of the moves, mean
    double kkt_residual = 0.0;
    int not_solved = 0;  ///< samples without a move
  };

  Times run(const QpSolverFactory& factory, int samples) const;

  /// The programs of the moves of `count` samples from sample `first` on, with the answers of the active-set
  /// method.
  struct Programs {
    QpStructure structure;
    std::vector<QpData> data;
    std::vector<Eigen::VectorXd> answers;
  };
  Programs programs(int first, int count) const;

 private:
  /// Calls visit(sample, seconds of the controller's step, its move) for a loop with `controller`.
  template <class Visit>
  void visit_steps(Mpc& controller, int samples, const Visit& visit) const;

  PlantSize size_;
  TransferMatrix model_;  ///< MVs, then MDs
  MpcOptions options_;
};

}  // namespace mpm
