#include <algorithm>
#include <cmath>

#include "hammer_loads/life/life_settings.h"
#include "hammer_loads/ros/bag_tables.h"
#include "hammer_loads/ros/stamp.h"
#include "hammer_loads/settings/readers.h"

namespace hammer_loads {

void LifeTables::begin(HammerBridge& bridge, std::int64_t run) {
  run_ = run;
  cycles_ = {};
  alarms_.clear();
  budget_.emplace(bridge.pipeline());
  bridge.watch([this] { budget_->follow(); });
  bridge.outputs().turn_loads.attach([this](const TurnLoads& message, const ros::Time&) { takeTurn(message); });
  bridge.outputs().alarms.attach([this](const Alarms& message, const ros::Time&) { takeAlarms(message); });
  bridge.outputs().load_cycles.attach([this](const LoadCycles& message, const ros::Time&) { cycles_ = message; });
}

/// Writes the loads of a revolution that was seen as a whole, like the rows of the table `turns`.
void LifeTables::takeTurn(const TurnLoads& message) {
  if (!message.whole) return;
  for (std::size_t i = 0; i < message.channel.size(); ++i)
    writer_->add("turn_loads", run_, message.turn, i, message.minimum[i], message.maximum[i], message.mean[i],
                 message.minimum_std[i], message.maximum_std[i], message.minimum_systematic_std[i],
                 message.maximum_systematic_std[i]);
}

/// Adds the alarms of a revolution. An alarm lasts from the revolution that raised it to the last one of the same
/// level. Its value is the one farthest beyond the limit.
void LifeTables::takeAlarms(const Alarms& message) {
  for (const Alarm& alarm : message.alarm) {
    auto row = std::find_if(alarms_.rbegin(), alarms_.rend(),
                            [&](const RaisedAlarm& raised) { return raised.alarm.name == alarm.name; });
    if (row == alarms_.rend() || row->alarm.since != alarm.since) {
      alarms_.push_back({alarm, {}, 0});
      row = alarms_.rbegin();
    }
    if (std::abs(alarm.value - alarm.limit) > std::abs(row->alarm.value - row->alarm.limit))
      row->alarm.value = alarm.value, row->alarm.value_std = alarm.value_std;
    row->until = message.header.stamp;
    ++row->turns;
  }
}

void LifeTables::write(const BudgetFigure& figure) {
  double all = 0.0;
  for (const BudgetFigure::Source& source : figure.sources) all += source.variance;
  for (const BudgetFigure::Source& source : figure.sources)
    writer_->add("budget", run_, figure.quantity, life::unitOf(figure.quantity), figure.value, figure.deviation,
                 source.name, source.variance / all);
}

/// Writes the uncertainty budgets. A hull channel's range has the shares of its own budget. The boom's channels do not
/// separate their constants: they have one share of all constants and one of the rest.
void LifeTables::writeBudget() {
  for (const BudgetFigure& figure : budget_->figures()) write(figure);
  const std::vector<std::string> names = channelNames(nullptr);  // names of the hull's channels
  for (const ChannelCycles& channel : cycles_.channel) {
    if (channel.equivalent_range.empty() || !(channel.equivalent_range.front() > 0.0)) continue;
    BudgetFigure figure{"equivalent_range_" + std::to_string(static_cast<int>(life::kSlopes[0])) + "/" + channel.name,
                        channel.equivalent_range.front(),
                        channel.equivalent_range_std.front(),
                        {}};
    const auto of_hull = std::find(names.begin(), names.end(), channel.name);
    if (of_hull != names.end()) {
      figure.sources = budget_->ofRange(static_cast<std::size_t>(of_hull - names.begin()));
    } else if (channel.range_own_std >= 0.0 && channel.range_systematic_std >= 0.0) {
      figure.sources = {
          {"constants of hammer and crank sensor", channel.range_systematic_std * channel.range_systematic_std},
          {"readings, oil and rock", channel.range_own_std * channel.range_own_std}};
    }
    write(figure);
  }
}

void LifeTables::writeReference(const ReferenceComparison& comparison) {
  for (std::size_t i = 0; i < ReferenceComparison::kComponents; ++i) {
    const ReferenceFigures f = comparison.figures(i);
    const std::string name = ReferenceComparison::kNames[i];
    if (f.samples > 0)
      writer_->add("reference", run_, name, life::unitOf(name), f.samples, f.rms, f.rms_error, f.bias, f.scale,
                   f.correlation, f.within_two_std);
  }
}

void LifeTables::writeCount(std::size_t number, const ChannelCycles& m, const life::CountedChannel& channel) {
  const auto ofCurve = [&](double (life::SnCurve::*figure)() const) {
    return channel.curve ? ((*channel.curve).*figure)() : kNaN;
  };
  writer_->add("channels", run_, number, m.name, m.unit, true, m.least, m.greatest, m.classes, m.samples, m.skipped,
               m.below, m.above, m.gaps, m.minimum, m.maximum, m.mean_std, m.range_own_std, m.range_systematic_std,
               ofCurve(&life::SnCurve::kneeRange), ofCurve(&life::SnCurve::kneeCycles), ofCurve(&life::SnCurve::slope),
               ofCurve(&life::SnCurve::slopeBelow), channel.mean_stress ? channel.mean_stress->sensitivity : kNaN);
  for (std::size_t i = 0; i < m.count.size(); ++i)
    writer_->add("cycles", run_, number, m.steps[i], m.low[i], m.count[i]);
  for (std::size_t i = 0; i < m.residue.size(); ++i) writer_->add("residues", run_, number, i, m.residue[i]);
}

void LifeTables::end(const HammerBridge& bridge) {
  writeBudget();
  for (const RaisedAlarm& raised : alarms_) {
    const Alarm& a = raised.alarm;
    writer_->add("alarms", run_, a.name, a.level, a.unit, a.value, a.value_std, a.limit, stampOf(a.since),
                 stampOf(raised.until), raised.turns);
  }
  writeReference(bridge.comparison());
  std::vector<std::string> names = bridge.outputs().turn_loads.message.channel;
  for (const ChannelCycles& counted : cycles_.channel)
    if (std::count(names.begin(), names.end(), counted.name) == 0) names.push_back(counted.name);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto counted = std::find_if(cycles_.channel.begin(), cycles_.channel.end(),
                                      [&](const ChannelCycles& cycles) { return cycles.name == names[i]; });
    const auto at = static_cast<std::size_t>(counted - cycles_.channel.begin());
    if (counted != cycles_.channel.end())
      writeCount(i, *counted, bridge.life().machine().channels[at]);
    else
      writer_->add("channels(run_id, channel, name, unit, counted)", run_, i, names[i], life::unitOf(names[i]), false);
  }
}

}  // namespace hammer_loads
