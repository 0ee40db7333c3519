#pragma once

namespace mpm {

/// The stem of a sticking control valve, whose position follows a signal. Positions and signals are in the
/// unit of the MV.
class ValveStem {
 public:
  virtual ~ValveStem() = default;

  /// Applies the signal `u` and returns the position after it.
  virtual double follow(double u) = 0;

 protected:
  ValveStem() = default;
  ValveStem(const ValveStem&) = default;
  ValveStem& operator=(const ValveStem&) = default;
};

/// Stiction with the two parameters S and J of Choudhury, Thornhill and Shah ("Modelling valve stiction",
/// Control Engineering Practice 13, 2005, 641-658), with a stop at every reversal as in Kano et al.
/// ("Practical model and detection algorithm for valve stiction", IFAC DYCOPS, 2004). The stem rests when the
/// signal stops or turns. With u_s the signal at which it stopped, it moves again when the signal is more
/// than S beyond u_s in the other direction, or more than J in the same one. A moving stem stands at
///
///   x = u - d (S - J) / 2,   d = 1 upwards, -1 downwards,
///
/// so that it jumps by J when it breaks loose after a reversal, and lags by the deadband S - J. J = 0 is a
/// deadband without a jump.
class StickyValve final : public ValveStem {
 public:
  /// The valve is at rest under the signal `u`. `start`, from -1 to 1, is the distance of the stem from the
  /// signal as a share of the largest possible distance, (S + J) / 2; 0: the stem stands at u and last moved
  /// upwards. Errors: InputError unless S and J are finite and >= 0.
  StickyValve(double stickband, double jump, double u, double start = 0.0);

  double follow(double u) override;

 private:
  double stickband_, jump_;
  double position_, previous_, rest_;
  double last_move_ = 0.0;
  double direction_ = 1.0;
  bool rests_ = true;
};

/// Stiction by friction after He, Wang, Pottmann and Qin ("A curve fitting method for detecting valve
/// stiction in oscillating control loops", Industrial and Engineering Chemistry Research 46, 2007,
/// 4549-4560). A force u - x below the static friction f_S leaves the stem x where it is; a larger one moves
/// it until the kinetic friction f_D is left,
///
///   x(k) = x(k-1)            where |u(k) - x(k-1)| <= f_S,
///   x(k) = u(k) -+ f_D       otherwise, - for an upward move.
///
/// The stem is at rest between samples: each move has to overcome f_S. In terms of StickyValve S = f_S + f_D
/// and J = f_S - f_D. With f_D = 0 it is the valve of Stenman, Gustafsson and Forsman ("A segmentation-based
/// method for detection of stiction in control valves", International Journal of Adaptive Control and Signal
/// Processing 17, 2003, 625-634): it stays until |u - x| > d = f_S, and then jumps to u.
class FrictionValve final : public ValveStem {
 public:
  /// The stem is at rest under the signal `u`, at position u + start f_S. Errors: InputError unless both
  /// frictions are finite and 0 <= f_D <= f_S.
  FrictionValve(double static_friction, double kinetic_friction, double u, double start = 0.0);

  double follow(double u) override;

 private:
  double static_, kinetic_, position_;
};

}  // namespace mpm
