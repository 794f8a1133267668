#include <algorithm>
#include <cmath>

#include "hammer_loads/simulation/hammer_on_boom.h"
#include "hammer_loads/util/constants.h"

namespace hammer_loads::simulation {
namespace {

constexpr double kNear = 0.005;     // height of the striking point over the dead centre below which steps are short [m]
constexpr double kShort = 1e-5;     // step near a blow, which lasts some thirty of them [s]
constexpr double kBriefest = 1e-7;  // longest step in which a contact may begin or end [s]
constexpr double kReach = 1.5;      // step times the decay rate of the rod's damping; Runge-Kutta is stable up to 2.8
constexpr double kLong = 4e-5;      // step during the vibration after a blow [s]; 50 per period at 500 Hz
constexpr double kRings = 0.05;     // duration of the vibration after a blow [s]; later the step is doubled

}  // namespace

HammerOnBoom::Rocker HammerOnBoom::rockerAt(const State& s) const {
  if (!elastic_) return links_.at({s.x()[3], s.before_blow, false}).body[0];
  const HammerParameters& p = machine_.hammer;
  const double ls = p.rocker_com_distance;
  const Jet psi{s.x()[4], 1.0, 0.0}, to_com = psi + p.rocker_com_angle;
  return {p.rocker_mass, p.rocker_inertia_about_pivot - p.rocker_mass * ls * ls,
          ls * cos(to_com) + p.lengths.pivot_distance, ls * sin(to_com), psi};
}

StruckTool::Striker HammerOnBoom::striker(const State& s) const {
  const std::complex<double> rocker = ElasticLinks::rockerAt(s.x()[4]);
  return {elastic_->links.depth(rocker), elastic_->links.depthSlope(rocker) * s.v()[4]};
}

double HammerOnBoom::gravityDown(const State& s) const { return machine_.gravity * std::cos(hullAngle(s)); }

StruckTool::Answer HammerOnBoom::struck(const State& s) const {
  return elastic_->struck.answer(striker(s), s.tool(), gravityDown(s));
}

PlanePoint HammerOnBoom::strikingPlace(const State& s) const {
  const double lk = machine_.hammer.striking_distance;
  return jointPlace(s, 3) + turnedBy(hullAngle(s)) * PlanePoint(-lk * std::cos(s.x()[4]), lk * std::sin(s.x()[4]));
}

/// Returns the derivatives of the striking point's height along the tool by the coordinates.
HammerOnBoom::Coordinates HammerOnBoom::toolLift(const State& s) const {
  const PlanePoint place = strikingPlace(s), down = std::conj(turnedBy(hullAngle(s)));
  Coordinates lift = Coordinates::Zero();
  for (std::size_t k = 0; k < turns(); ++k) lift[turnIndex(k)] = (-kI * (place - turnPlace(s, k)) * down).imag();
  lift[4] = -elastic_->links.depthSlope(ElasticLinks::rockerAt(s.x()[4]));
  return lift;
}

/// The rod pulls crank and rocker together; the tool pushes rocker, hull and boom up; the retainer pushes the rocker
/// against the hull it belongs to.
HammerOnBoom::Coordinates HammerOnBoom::elasticForce(const State& s) const {
  const RodStretch rod = elastic_->links.rod({s.x()[3], s.x()[4]});
  const double tension = elastic_->rod.tension(rod.stretch, rod.rate({s.v()[3], s.v()[4]}));
  const StruckTool::Answer answer = struck(s);
  Coordinates Q = Coordinates::Zero();
  if (answer.tool > 0.0) Q = answer.tool * toolLift(s);
  Q[3] -= tension * rod.slope[0];
  Q[4] -= tension * rod.slope[1] + answer.retainer * elastic_->links.depthSlope(ElasticLinks::rockerAt(s.x()[4]));
  return Q;
}

int HammerOnBoom::contacts(const State& s) const {
  const double pressed = elastic_->rod.pressed(elastic_->links.rod({s.x()[3], s.x()[4]}).stretch);
  const bool play = machine_.rod.play > 0.0;
  return elastic_->struck.contacts(striker(s), s.tool()) + (play && pressed > 0.0 ? 8 : 0) +
         (play && pressed < 0.0 ? 16 : 0);
}

/// Interpolates the operator's slow motion linearly between two instants.
HammerOnBoom::Hold HammerOnBoom::holdBetween(double time) const {
  const double length = hold_later_.state.time - hold_.state.time, part = (time - hold_.state.time) / length;
  Hold hold = hold_;
  hold.state.time = time;
  hold.state.x() += part * (hold_later_.state.x() - hold_.state.x());
  hold.state.v() += part * (hold_later_.state.v() - hold_.state.v());
  hold.weight += part * (hold_later_.weight - hold_.weight);
  hold.stiffness += part * (hold_later_.stiffness - hold_.stiffness);
  hold.bent += part * (hold_later_.bent - hold_.bent);
  return hold;
}

void HammerOnBoom::advanceElastic(double time) {
  const HammerParameters& p = machine_.hammer;
  const double l1 = p.lengths.crank, l3 = p.lengths.rocker;
  const double damping = machine_.rod.damping_ratio * machine_.rod.stiffness / (200.0 * kPi);
  const double decay = damping * (l3 * l3 / p.rocker_inertia_about_pivot + l1 * l1 / rotor_);
  while (now_.time < time) {
    if (!(now_.time < hold_later_.state.time)) {
      followOperator();
      hold_later_ = holdAt(now_.time + machine_.on_boom.step);
    }
    const double calm = now_.time < last_blow_ + kRings ? kLong : 2.0 * kLong;
    double longest = std::min({step_, calm, kReach / decay});
    const int before = contacts(now_);
    if (StruckTool::touches(before) || striker(now_).depth > -kNear) longest = std::min(longest, kShort);
    const double left = std::min(time, hold_later_.state.time) - now_.time;
    double dt = std::min({longest, left, next_step_ > 0.0 ? next_step_ : longest});
    State next = stepped(now_, dt);
    while (contacts(next) != before && dt > kBriefest) {
      dt = std::max(0.25 * dt, 0.9 * kBriefest);
      next = stepped(now_, dt);
    }
    next_step_ = 4.0 * dt;
    if (dt == left) next.time = std::min(time, hold_later_.state.time);
    acceptElastic(next);
  }
}

void HammerOnBoom::acceptElastic(const State& next) {
  const bool put_back = now_.x()[4] <= 1.0 && next.x()[4] > 1.0;  // rocker far from the tool, on its way up
  const bool was_before = now_.before_blow;
  now_ = next;
  if (now_.x()[3] > kPi) now_.x()[3] -= kTwoPi;
  if (now_.x()[3] < -kPi) now_.x()[3] += kTwoPi;
  now_.before_blow = now_.x()[3] < 0.0;
  if (std::abs(now_.x()[3]) < 0.5 * kPi && was_before != now_.before_blow) turn_ += was_before ? 1 : -1;
  if (now_.v()[3] < 0.0) whole_turn_ = false;
  BlowTruth* begun =
      follower_.follow({now_.time, now_.v()[3], now_.v()[4], striker(now_).speed, now_.y[kToolImpulse],
                        now_.y[kToolEnergy], now_.y[kRetainerImpulse], StruckTool::touches(contacts(now_))});
  if (begun) endTurn(*begun);
  if (put_back) elastic_->struck.newTurn(now_.time), now_.y.segment<3>(kTool).setZero();
}

}  // namespace hammer_loads::simulation
