/// Straight-line grapple: from slider position to every pin and to the jaw edge, on one branch.
///
/// Neglects joint clearance, elasticity and masses: geometry only. The same slider position admits several poses; the
/// working branch is the one through the reference pose, from the fold or dead centre below it to the one above. There
/// the pose is a function of the slider position, and nothing else is ever returned. Derivation and errata:
/// doc/grapple.md.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "hammer_loads/grapple/folds.h"
#include "hammer_loads/grapple/grapple_motion.h"
#include "hammer_loads/grapple/grapple_parameters.h"
#include "hammer_loads/grapple/lever_group.h"
#include "hammer_loads/grapple/slider_drive.h"
#include "hammer_loads/util/checked.h"

namespace hammer_loads {

/// End of the working branch.
struct SliderLimit {
  enum class Kind {
    kDeadCentre,  ///< O1, H and G in line: the slider cannot move rocker 1 further
    kFold,        ///< det J = 0: the lever group reaches no further
    kSingular,    ///< branches cross or the pose moves by itself
  };
  Kind kind{};
  double slider{};  ///< [m]; of a fold to some 1e-15
};

/// Name of a limit: "dead centre", "fold" or "crossing of branches".
const char* nameOf(SliderLimit::Kind kind) noexcept;

/// Reason why there is no pose for a slider position.
enum class SliderRefusal {
  kNone,
  kNotFinite,         ///< NaN or infinite
  kOutOfReach,        ///< the drive does not close: beyond a dead centre
  kAcrossDeadCentre,  ///< the drive closes again, but only on the other side of a dead centre
  kAcrossFold,        ///< beyond the fold that ends the branch, whether or not another branch exists there
  kOutsideStroke,     ///< a regular pose, but the jaws overlap or open too far
  kNotFound,          ///< numerical failure; not known to happen
};
inline constexpr int kSliderRefusalKinds = 7;

/// Name of a refusal in one or two words, for counters in diagnostics.
const char* nameOf(SliderRefusal refusal) noexcept;

class Grapple {
 public:
  /// Makes a grapple, or reports every violated rule at once; keys as in the grapple file.
  static Checked<Grapple> make(const GrappleParameters& parameters);

  const GrappleParameters& parameters() const noexcept { return parameters_; }
  const SliderLimit& lowerLimit() const noexcept { return lower_; }
  const SliderLimit& upperLimit() const noexcept { return upper_; }

  /// Judges a slider position: kNone inside the working branch; the stroke is not considered.
  SliderRefusal judge(double slider) const noexcept;
  /// Judges as judge(), and returns kOutsideStroke beyond the stroke by more than slider_margin.
  SliderRefusal judgeInStroke(double slider) const noexcept;
  /// Explains a refusal in one line: name, slider position, unit, allowed range.
  std::string explain(SliderRefusal refusal, double slider, const std::string& name = "slider position") const;

  /// Motion at a slider position, found among all branches by their polynomial. None unless judge() returns kNone.
  std::optional<GrappleMotion> at(double slider) const noexcept;
  /// Motion at a slider position near another motion on the working branch: predictor and Newton, shorter steps where
  /// those do not settle, at() as a last resort. It equals at() to rounding. None unless judge() returns kNone.
  std::optional<GrappleMotion> follow(const GrappleMotion& from, double slider) const noexcept;

  /// Directions of the paper's links 1 to 6, right jaw: O1A, AB, BD, CE, OD, GH. For pictures, not for the hot path.
  std::array<LinkDirection, 6> linkDirections(const GrappleMotion& motion) const noexcept;

 private:
  explicit Grapple(const GrappleParameters& parameters);

  /// Each returns false after adding problems.
  bool findReference(std::vector<std::string>& problems);
  void findLimits();
  SliderLimit limit(const Reach& reach, const std::array<BranchEnd, 2>& ends, int side) const;
  void checkStroke(std::vector<std::string>& problems) const;

  bool inside(double slider) const noexcept;
  GrappleMotion motionOf(double slider, const DriveMotion& drive, const GroupPose& pose,
                         const Closure& closure) const noexcept;
  bool step(const GrappleMotion& from, double slider, GrappleMotion& to) const noexcept;
  bool walk(const GrappleMotion& from, double slider, GrappleMotion& to) const noexcept;
  Planar arm(const DriveMotion& drive) const noexcept { return drive.o1h * a_by_h_; }

  GrappleParameters parameters_;
  SliderDrive drive_;
  LeverGroup group_;
  Planar a_by_h_;  ///< O1A = O1H * a_by_h
  GrappleMotion reference_;
  SliderLimit lower_, upper_;
};

}  // namespace hammer_loads
