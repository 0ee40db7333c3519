#pragma once

#include "plants/linear/plant_model.hpp"

// The benchmark plants that are given by a table of transfer functions.

namespace mpm {

/// The Shell heavy oil fractionator, 7 CVs x 3 MVs x 2 MDs ("shell-7x3"): thesis, eq. 6.18 and table 6.1,
/// after Prett and Morari (1987) and Maciejowski (2002).
///
/// Every channel is gain e^{-dead_time s} / (time_constant s + 1), times in minutes. The variables are
/// deviations without a stated unit. The dead time of channel (y4, u2), printed without its s in eq. 6.18, is
/// 12 min.
PlantModel shell_fractionator_7x3();

/// P2, the 3 x 3 part that chapters 2, 4 and 5 control by setpoints: eq. 2.25 and 4.18, times in minutes. Its
/// y3 is the y7 of eq. 6.18, with a dead time of 19 min from u3 instead of none.
PlantModel shell_fractionator_3x3();

/// P8, a high-purity binary distillation column in LV configuration (Skogestad & Postlethwaite), eq. 4.15:
///
///                1      [  87.8   -86.4 ]
///   [yD; xB] = -------- [ 108.2  -109.6 ] [L; V],   time in minutes.
///              75 s + 1
///
/// Its condition number is 142 at every frequency and its relative gain 35: the outputs are nearly dependent.
PlantModel distillation_column();

/// P9, the model of the SISO case study (5.3.1, table 5.1), with an inverse response; time in seconds:
///
///           -100 s + 3.04
///   G0 = --------------------.
///        305 s^2 + 40 s + 1
///
/// The plant with mismatch of table 5.2 has 18.25 instead of 3.04.
PlantModel siso_plant();

/// The pilot column of Ogunnaike and Ray for ethanol and water, with a side stream, 3 CVs x 3 MVs x 2 MDs
/// ("ogunnaike-ray"): B. A. Ogunnaike, J. P. Lemaire, M. Morari and W. H. Ray, "Advanced multivariable
/// control of a pilot-plant distillation column", AIChE Journal 29 (1983), 632-640; times in minutes.
///
/// CVs are mole fractions and a temperature in deg C, inputs are flows in gal/min, a pressure in psi and a
/// temperature, so that gains range from 0.0011 to 46. The channel from the steam pressure to the tray
/// temperature and two channels of the feed temperature are of second order with a zero.
PlantModel ogunnaike_ray_column();

/// The forced-circulation evaporator of R. B. Newell and P. L. Lee, "Applied process control: a case study"
/// (1989), 3 CVs x 3 MVs x 3 MDs ("evaporator"); times in minutes. Its level integrates.
///
/// The model is the linearisation of the nonlinear equations of the book at F2 = 2 kg/min, X2 = 25 % and P2 =
/// 50.5 kPa. Slopes of the rates with respect to states and inputs:
///
/// | rate of | X2           | P2          | F2    | P100          | F200         | F1          | X1  | T1 |
/// |---------|--------------|-------------|-------|---------------|--------------|-------------|-----|----|
/// | X2      | -0.1         | 0           | -1.25 | 0             | 0            | 0.25        | 0.5 | 0  |
/// | P2      | -0.02090766  | -0.05579782 | 0     | 0.009587532   | -0.001828122 | 0.016437197 | 0   | a  |
/// | L2      | 0.004181532  | 0.007512310 | -0.05 | -0.0019175065 | 0            | 0.046712561 | 0   | b  |
///
/// with a = 0.0045454545 and b = -0.0009090909. The vapour that raises P2 leaves the liquid, so that the
/// level answers every input.
PlantModel evaporator();

/// A binary column with the levels of its condenser and reboiler, 4 CVs x 4 MVs x 1 MD ("column-levels"): the
/// compositions of distillation_column() by reflux L and boilup V, per kmol/min (S. Skogestad, M. Morari and
/// J. C. Doyle, IEEE Trans. Automatic Control 33 (1988), 1092-1105), and two holdups that integrate, with
/// constant molar flows and a liquid lag of theta = 2.46 min from top to bottom; times in minutes:
///
///   M_D = (V - L - D)/s,    M_B = (e^{-theta s} L + e^{-theta s/2} F - V - B)/s.
///
/// The products D and B change the compositions through the levels only. The feed F is liquid and enters
/// halfway; its gains of yD and xB, 0.394 and 0.586 per kmol/min, are those of S. Skogestad and I.
/// Postlethwaite, "Multivariable feedback control" (1996), for the same column.
PlantModel distillation_column_with_levels();

/// A made-up unit as large as industrial ones, 20 CVs x 8 MVs x 2 MDs ("banded-20x8"); times in minutes. CV i
/// = 1 ... 20 stands at p = 1 + 7 (i - 1)/19 along a train of eight places, and MV j at the place j. With
/// delta = |p - j|, CV i answers the MVs with delta < 2.2 only:
///
///   G_ij(s) = g_ij e^{-theta_ij s} / (tau_ij s + 1),
///   g_ij     = +-(2 + ((3 i + 2 j) mod 5)/4) e^{-0.8 delta},   minus where i + j is a multiple of 3,
///   tau_ij   = 8 + 3 ((2 i + 5 j) mod 8) min,
///   theta_ij = 1 + ((i + 3 j) mod 4) + round(2 delta) min.
///
/// MD k = 1, 2 enters at the place 2.5 + 4 (k - 1) and acts on the CVs within 4 of it. Its channels follow
/// the same formulas with j = 8 + k, half the gain, and e^{-0.4 delta}. No number was chosen to suit a
/// method: remainders take the place of random numbers, and every number can be computed by hand.
PlantModel banded_unit_20x8();

}  // namespace mpm
