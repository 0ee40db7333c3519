#pragma once

namespace mpm {

/// The stem of a control valve that sticks: where it stands when a signal asks for something. Positions and
/// signals are in the unit of the MV.
class ValveStem {
 public:
  virtual ~ValveStem() = default;

  /// Its position after the signal `u`.
  virtual double follow(double u) = 0;

 protected:
  ValveStem() = default;
  ValveStem(const ValveStem&) = default;
  ValveStem& operator=(const ValveStem&) = default;
};

/// Stiction with the two parameters S and J of Choudhury, Thornhill and Shah ("Modelling valve stiction",
/// Control Engineering Practice 13, 2005, 641-658), with the stop at every reversal as Kano et al. have it
/// ("Practical model and detection algorithm for valve stiction", IFAC DYCOPS, 2004). The stem rests when the
/// signal stops or turns. It moves again when the signal is S beyond the point u_s of its rest in the other
/// direction, or J in the same one. A moving stem stands at
///
///   x = u - d (S - J) / 2,   d = 1 upwards, -1 downwards,
///
/// so that it jumps by J when it breaks loose after a reversal, and lags by the deadband S - J. J = 0 is a
/// deadband without a jump.
class StickyValve final : public ValveStem {
 public:
  /// At rest where the signal is `u`. Errors: InputError unless S and J are finite and >= 0.
  StickyValve(double stickband, double jump, double u);

  double follow(double u) override;

 private:
  double stickband_, jump_;
  double position_, previous_, rest_;
  double last_move_ = 0.0;
  double direction_ = 1.0;
  bool rests_ = true;
};

}  // namespace mpm
