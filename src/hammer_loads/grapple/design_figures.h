/// A designer's figures of the grapple: opening, scoop height, how straight the path of the jaw edge is.
///
/// The paper gives "80 %" and "3 %" without a definition. Here, for the path of P between two slider positions, closed
/// and open, with arc length l measured from the closed one and total length L:
/// deviation of a part = (highest - lowest y of P)/2 over the part's arc length;
/// straight share for a tolerance = largest l/L whose part [0, l] has a deviation of at most that tolerance;
/// line = the height midway between the extremes of the first 80 % of L;
/// scoop height = y of P open above that line.
#pragma once

#include "hammer_loads/grapple/grapple.h"

namespace hammer_loads {

inline constexpr double kClaimedStraightShare = 0.8;  ///< Gebel 2017, conclusion
inline constexpr double kClaimedDeviation = 0.03;     ///< Gebel 2017, conclusion

/// A figure and the slider position [m] where it occurs.
struct Extreme {
  double value{};
  double slider{};
};

struct DesignFigures {
  double slider_closed{}, slider_open{};  ///< [m]
  double opening{};                       ///< between both jaw edges when open, 2 x_P [m]
  double jaw_travel{};                    ///< x_P open less x_P closed [m]
  double path_length{};                   ///< L of one jaw edge [m]
  double line_height{};                   ///< y [m]
  double scoop_height{};                  ///< [m]; negative if the open end drops below the line
  double deviation_first_80{};            ///< deviation over the first 80 % of L [-]
  double deviation_whole{};               ///< deviation over all of L [-]
  double straight_share_band{};           ///< for a tolerance of 1.5 %: the paper's 3 % read as the width of a band [-]
  double straight_share_off{};            ///< for a tolerance of 3 %: read as the distance from the band's middle [-]
  Extreme least_determinant;              ///< |det J| [m4]
  Extreme worst_condition;                ///< largest 2-norm condition number of J [-]
  Extreme least_transmission;             ///< angle O1-H-G [rad]
  Extreme most_transmission;              ///< angle O1-H-G [rad]
};

/// Precondition: judge() is kNone for both. Lengths to some 1e-9 m, those at 80 % to 1e-7; extremes of
/// conditioning are those of 2049 equidistant positions.
DesignFigures designFigures(const Grapple& grapple, double slider_closed, double slider_open);

/// Slider position [m] within the stroke at which the jaw edges are `opening` [m] apart (2 x_P), to some 1e-15. One of
/// them if the path turns back. The problem names the reachable openings.
Checked<double> sliderForOpening(const Grapple& grapple, double opening);

}  // namespace hammer_loads
