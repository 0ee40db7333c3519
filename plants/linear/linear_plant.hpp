#pragma once

#include <memory>
#include <vector>

#include <Eigen/Core>

#include "plants/linear/transfer_matrix.hpp"
#include "plants/output_sampling.hpp"
#include "plants/plant.hpp"

namespace mpm {

struct ChannelTable;

/// A linear plant y = G u between samples, simulated exactly for inputs held over each sample.
///
/// Every channel G_ij has its own state (see DiscreteChannel), so that dead times may differ freely:
///
///   y_i(k) = sum_j ( c_ij x_ij(k) + d_ij u_j(k - delay_ij - 1) ).
///
/// y(k) is sampled just before u(k) acts: a controller reads output(), computes u(k) and calls advance(u(k)).
///
/// The discretised channels are shared by all copies. Assigning one plant to another that was copied from it
/// (or built from a matrix with the same channel orders and delays) copies a few small arrays and allocates
/// nothing, which makes it cheap to run the free response of a plant from its present state.
class LinearPlant final : public Plant {
 public:
  /// A plant at rest. With OutputSampling::average y(k) is the mean over the sample time before sample k.
  /// Errors: InputError as discretise().
  LinearPlant(const TransferMatrix& G, double sample_time,
              OutputSampling sampling = OutputSampling::snapshot);

  Eigen::Index output_count() const override { return output_.size(); }
  Eigen::Index input_count() const override { return input_count_; }

  /// Ts, in the time unit of the transfer matrix.
  double sample_time() const override;

  /// Puts every channel at its steady state under the constant `steady_input` (input_count()), as if it had
  /// acted for ever; an integrating channel has the output 0 and a steady rate. The plant rests if these
  /// rates cancel out in each output. Errors: InputError for a wrong size, or a number that is not finite.
  void reset(const Eigen::Ref<const Eigen::VectorXd>& steady_input) override;

  /// y(k), output_count(): just before the input of sample k is applied.
  const Eigen::VectorXd& output() const override { return output_; }

  /// Holds u(k) = `input` (input_count()) over [k Ts, (k+1) Ts) and goes on to sample k + 1. Allocates
  /// nothing when `input` is a vector or a column (an expression is first stored by Eigen::Ref). Errors:
  /// InputError for a wrong size. A number that is not finite spreads to the outputs; the status is always
  /// ok.
  PlantStatus advance(const Eigen::Ref<const Eigen::VectorXd>& input) override;

 private:
  bool push_input(const Eigen::Ref<const Eigen::VectorXd>& input);
  void read_inputs();
  template <class Update>
  void add_up_first_order(const Update& update);
  void advance_first_order();
  void advance_second_order(const double* newest);
  void advance_general(const double* newest);
  void add_up_others();
  void advance_coefficients(const Eigen::Ref<const Eigen::VectorXd>& input);
  void hold_last_coefficients(const Eigen::Ref<const Eigen::VectorXd>& input, Eigen::Index at);

  std::shared_ptr<const ChannelTable> table_;
  Eigen::Index input_count_;
  Eigen::VectorXd state_;
  Eigen::VectorXd next_state_;  // room for the new state of one general channel
  Eigen::VectorXd output_;
  // The last L input vectors as a ring of L columns, written twice (columns h and h + L): the L vectors up to
  // the newest one, in column newest_, then always stand side by side and no index has to be wrapped.
  Eigen::MatrixXd history_;
  Eigen::Index newest_;
  Eigen::Index repeats_;  // how many of the newest inputs in succession are equal
  // For the first-order channels: the input that acts at this sample, and what this input and the one before
  // it add to the state and to the output.
  Eigen::ArrayXd now_, forced_now_, forced_previous_, direct_;
  // What the channels of step coefficients add to y(k), y(k+1), ... if the inputs stay as they are: rows from
  // coming_ on, one column for each output. Dynamic matrix control predicts in the same way. There are twice
  // as many rows as coefficients, so that the rows are moved only once in as many samples.
  Eigen::MatrixXd ahead_;
  Eigen::Index coming_ = 0;
};

/// Returns the response of G from rest to `inputs` (n_in x N): outputs (ny x N), whose column k is sampled
/// just before column k of the inputs acts. Errors: InputError for a wrong number of rows, or as
/// discretise().
Eigen::MatrixXd simulate(const TransferMatrix& G, double sample_time,
                         const Eigen::Ref<const Eigen::MatrixXd>& inputs,
                         OutputSampling sampling = OutputSampling::snapshot);

/// Unit step responses. Entry j of the result belongs to input j: an ny x `samples` matrix whose column k - 1
/// is y(k), k = 1 ... samples, after a step of input j from 0 to 1 at k = 0. Errors: InputError for a
/// negative number of samples, or as discretise().
std::vector<Eigen::MatrixXd> step_response(const TransferMatrix& G, double sample_time, Eigen::Index samples);

}  // namespace mpm
