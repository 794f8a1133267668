#include "hammer_loads/ros/fill_life.h"

#include <algorithm>
#include <iterator>

#include "hammer_loads/life/life_settings.h"
#include "hammer_loads/ros/stamp.h"
#include "hammer_loads/util/constants.h"

namespace hammer_loads {
namespace {

void fillCount(const life::CycleCount& count, ChannelCycles& message) {
  message.least = count.grid.least();
  message.greatest = count.grid.greatest();
  message.classes = count.grid.classes();
  message.steps.clear(), message.low.clear(), message.count.clear();
  for (const life::ClosedCycles& closed : count.closed) {
    message.steps.push_back(closed.steps);
    message.low.push_back(closed.low);
    message.count.push_back(closed.count);
  }
  message.residue = count.residue;
  message.samples = count.tally.counted;
  message.skipped = count.tally.skipped;
  message.below = count.tally.below;
  message.above = count.tally.above;
  message.gaps = count.tally.gaps;
  message.minimum = count.extremes.least;
  message.maximum = count.extremes.greatest;
  message.mean_std = life::meanDeviation(count);
  const life::RangeDeviation range = life::rangeDeviation(count);
  message.range_own_std = count.tally.range_square > 0 ? range.own : kNaN;
  message.range_systematic_std = range.common;
}

void fillFigures(const life::ChannelFigures& figures, ChannelCycles& message) {
  for (std::vector<double>* values :
       {&message.equivalent_range, &message.equivalent_range_std, &message.equivalent_range_systematic_std})
    values->clear();
  for (const life::Figure& range : figures.equivalent_range) {
    message.equivalent_range.push_back(range.value);
    message.equivalent_range_std.push_back(range.deviation);
    message.equivalent_range_systematic_std.push_back(range.common);
  }
  message.largest_range = figures.largest_range;
  message.damage = figures.damage ? figures.damage->value : kNaN;
  message.damage_std = figures.damage ? figures.damage->deviation : kNaN;
  message.damage_systematic_std = figures.damage ? figures.damage->common : kNaN;
  message.remaining_hours = figures.remaining_hours ? figures.remaining_hours->value : kNaN;
}

}  // namespace

void prepareTurnLoads(const std::vector<std::string>& channels, TurnLoads& message) {
  message.channel = channels;
  message.unit.clear();
  for (const std::string& channel : channels) message.unit.push_back(life::unitOf(channel));
  for (std::vector<double>* values :
       {&message.minimum, &message.maximum, &message.mean, &message.minimum_std, &message.maximum_std,
        &message.minimum_systematic_std, &message.maximum_systematic_std})
    values->assign(channels.size(), kNaN);
}

void fillTurnLoads(const TurnEnd& end, const life::TurnLoads& turn, TurnLoads& message) {
  message.header.stamp = timeOf(end.stamp);
  message.turn = end.turn;
  message.whole = turn.whole;
  message.start = timeOf(turn.start);
  std::copy(turn.minimum.begin(), turn.minimum.end(), message.minimum.begin());
  std::copy(turn.maximum.begin(), turn.maximum.end(), message.maximum.begin());
  std::copy(turn.mean.begin(), turn.mean.end(), message.mean.begin());
  for (std::size_t i = 0; i < turn.of_minimum.size(); ++i) {
    message.minimum_std[i] = turn.of_minimum[i].deviation();
    message.maximum_std[i] = turn.of_maximum[i].deviation();
    message.minimum_systematic_std[i] = turn.of_minimum[i].common;
    message.maximum_systematic_std[i] = turn.of_maximum[i].common;
  }
}

void fillLoadCycles(StampNs since, const life::LifePiece& total, const life::LedgerMachine& machine,
                    LoadCycles& message) {
  constexpr double kSecondsPerHour = 3600.0;
  message.header.stamp = timeOf(total.stamp);
  message.since = timeOf(since);
  message.duration = kSecondsPerNs * static_cast<double>(total.duration);
  message.turns = total.turns;
  message.equivalent_cycles_per_hour = machine.equivalent_cycles_per_hour;
  message.slope.assign(std::begin(life::kSlopes), std::end(life::kSlopes));
  message.channel.resize(machine.channels.size());
  for (std::size_t i = 0; i < machine.channels.size(); ++i) {
    const life::LedgerChannel& channel = machine.channels[i];
    message.channel[i].name = channel.name;
    message.channel[i].unit = life::unitOf(channel.name);
    fillCount(total.counts[i], message.channel[i]);
    fillFigures(life::figuresOf(total.counts[i], channel, message.duration / kSecondsPerHour,
                                machine.equivalent_cycles_per_hour),
                message.channel[i]);
  }
}

}  // namespace hammer_loads
