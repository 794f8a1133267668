#include "hammer_loads/pipeline/step_impulse.h"

#include <algorithm>
#include <cmath>

#include "hammer_loads/hammer/hull_model.h"

namespace hammer_loads {
namespace {

/// One end of a part of the step.
struct PartEnd {
  CrankEstimate crank;
  LinkMotion links;
};

PartEnd endAt(const CrankStep& step, const CrankEstimate& crank) noexcept {
  return {crank, step.linksAt(crank.position.angle)};
}

/// Returns the impulse on the hull of a change of momentum.
LoadImpulse change(const HullModel& model, const DriveReaction& drive, const PartEnd& from_end,
                   const PartEnd& to_end) noexcept {
  const CrankEstimate &a = from_end.crank, &b = to_end.crank;
  const LinkMomentum from = linkMomentum(model, from_end.links, a.position.angle, a.speed);
  const LinkMomentum to = linkMomentum(model, to_end.links, b.position.angle, b.speed);
  const double drive_y = drive.by_crank * (a.speed - b.speed);
  return {{from.x - to.x, from.z - to.z, from.about_d - to.about_d + drive_y}, drive_y};
}

/// Returns the blow of a passage from the crank's speeds at it.
RockerBlow blowAt(const HullModel& model, double drive_inertia, const CrankStep::Passage& passage) noexcept {
  CrankBlow crank;
  crank.speed = passage.speed_before;
  crank.factor = passage.speed_after / passage.speed_before;
  crank.drive_inertia = drive_inertia;
  return measuredBlow(model, crank);
}

/// Calls visit(from, to) for each part of [from, to] between passages of the blow. A passage belongs to the part that
/// it ends; one at the very start of the step, where the estimate stood exactly at the blow, ends a part of no length.
template <typename Visit>
void forEachSmoothPart(const CrankStep& step, double from, double to, const Visit& visit) {
  const auto first = [](const CrankStep::Passage& p) { return p.forward ? Side::kBeforeBlow : Side::kAfterBlow; };
  const auto second = [](const CrankStep::Passage& p) { return p.forward ? Side::kAfterBlow : Side::kBeforeBlow; };
  CrankEstimate start = step.at(from);
  double start_time = from;
  bool passed_at_end = false;
  for (const CrankStep::Passage& passage : step) {
    if (passage.smooth || passage.time < from || passage.time > to) continue;
    if (passage.time == from && from > 0.0) {
      start = step.atSide(passage, second(passage));
      continue;
    }
    const CrankEstimate end = step.atSide(passage, first(passage));
    visit(start_time, passage.time == start_time ? end : start, passage.time, end);
    start = step.atSide(passage, second(passage));
    start_time = passage.time;
    passed_at_end = passage.time == to;
  }
  visit(start_time, start, to, passed_at_end ? start : step.at(to));
}

}  // namespace

LoadImpulse motionImpulse(const HullModel& model, const DriveReaction& drive, const CrankStep& step, double from,
                          double to) noexcept {
  LoadImpulse impulse;
  forEachSmoothPart(step, from, to, [&](double, const CrankEstimate& a, double, const CrankEstimate& b) {
    const LoadImpulse part = change(model, drive, endAt(step, a), endAt(step, b));
    impulse = {impulse.all + part.all, impulse.drive_y + part.drive_y};
  });
  return impulse;
}

LoadImpulse addedImpulse(const HullModel& model, const DriveReaction& drive, const CrankStep& step,
                         const HullPath& hull, double from, double to) noexcept {
  const double node = std::sqrt(0.6);
  const struct { double place, weight; } nodes[] = {{-node, 5.0 / 18.0}, {0.0, 8.0 / 18.0}, {node, 5.0 / 18.0}};
  LoadImpulse impulse;
  const auto add = [&](double time, double weight) noexcept {
    const CrankEstimate crank = step.at(time);
    const HullMotion motion = hull.at(time);
    const double drive_y = weight * drive.torque(0.0, motion.acceleration);
    impulse.all = impulse.all + weight * frameWrench(model, crank.position.angle, crank.speed, motion) +
                  HullWrench{0.0, 0.0, drive_y};
    impulse.drive_y += drive_y;
  };
  forEachSmoothPart(step, from, to, [&](double start, const CrankEstimate&, double end, const CrankEstimate&) {
    const int parts = std::max(1, static_cast<int>(std::ceil((end - start) / kPulseStep)));
    const double half = 0.5 * (end - start) / parts;
    for (int i = 0; i < parts; ++i) {
      const double middle = start + (2 * i + 1) * half;
      for (const auto& n : nodes) add(middle + n.place * half, 2.0 * half * n.weight);
    }
  });
  return impulse;
}

WrenchHistory wrenchHistory(const HullModel& model, const CrankStep& step) noexcept {
  WrenchHistory result;
  if (!step.known()) return result;
  const DriveReaction drive = driveReaction(model, step.driveInertia());
  const CrankStep::Passage* passage = step.begin();
  forEachSmoothPart(
      step, 0.0, step.length(), [&](double from, const CrankEstimate& a, double to, const CrankEstimate& b) {
        while (passage != step.end() && passage->smooth) ++passage;
        const CrankStep::Passage* ends_at = passage == step.end() ? nullptr : passage++;
        if (result.count == result.pieces.size()) return;
        SmoothPiece& piece = result.pieces[result.count++];
        piece.duration = to - from;
        const PartEnd begin = endAt(step, a), end = endAt(step, b);
        piece.from = hullWrench(model, drive, begin.links, motionOf(a), Gravity{});
        piece.to = hullWrench(model, drive, end.links, motionOf(b), Gravity{});
        const HullWrench impulse = change(model, drive, begin, end).all;
        piece.mean = piece.duration > 0.0 ? (1.0 / piece.duration) * impulse : 0.5 * (piece.from + piece.to);
        if (ends_at == nullptr || !ends_at->strikes) return;
        const RockerBlow blow = blowAt(model, step.driveInertia(), *ends_at);
        piece.ends_in_blow = true;
        piece.blow_std = step.timeDeviation(*ends_at);
        piece.blow = {blow.support_impulse_x, blow.support_impulse_z, blow.support_impulse_y + blow.drive_impulse_y};
      });
  return result;
}

}  // namespace hammer_loads
