/// The counted channels and the S-N lines of their cycles; the machine of a ledger with them, and the figures of a
/// count.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hammer_loads/life/cycle_count.h"
#include "hammer_loads/life/damage.h"

namespace hammer_loads::life {

/// One load's part in a stress.
struct Influence {
  std::string channel;  ///< any channel in use, counted or not
  double factor{};      ///< [MPa per unit of the channel]
};

/// A load, named as the topic and field that publish it; or the stress of a hot spot, `stress/NAME`, a sum of loads
/// that is formed at each sample.
struct CountedChannel {
  std::string name;                            ///< such as section_loads/NAME/torque_y
  LoadGrid grid;                               ///< in the channel's unit
  std::string key{};                           ///< short name in the parameter file
  std::vector<Influence> influences{};         ///< loads of a hot spot; empty: the channel is a load itself
  std::optional<SnCurve> curve{};              ///< without one: damage-equivalent ranges alone
  std::optional<FkmMeanStress> mean_stress{};  ///< none: the curve is used as it is
  std::int64_t id{};                           ///< number in the ledger; 0: it is not from one
};

struct LifeSettings {
  std::vector<CountedChannel> channels;  ///< loads, then hot spots
  std::int64_t period{};                 ///< period of ~load_cycles and the ledger [ns], > 0
  double equivalent_cycles_per_hour{};   ///< reference for damage-equivalent loads, > 0
  std::string ledger;                    ///< file; empty: none is kept
  double bandwidth{};                    ///< frequency up to which the loads are counted [Hz]; 0: all
};

/// Name under which a channel is counted: with a bandwidth `NAME_below_FHz`, so that counts of different bands never
/// add.
std::string countedName(const std::string& channel, double bandwidth);

/// Unit of topic/field, topic/name/field or stress/NAME by the comment of the message's field; "-" for no unit and for
/// an unknown name.
inline std::string unitOf(const std::string& channel) {
  if (channel.find("stress/") != std::string::npos) return "MPa";
  const std::string field = channel.substr(channel.rfind('/') + 1);
  const auto has = [&](const char* word) { return field.find(word) != std::string::npos; };
  if (has("impulse")) return "N s";
  if (has("force") || has("amplitude")) return "N";
  if (has("torque")) return "N m";
  return has("energy") ? "J" : "-";
}

/// The machine of the counts. Another identity or other channels or grids begin a new epoch: counts of different
/// machines never mix. Curves and equivalent cycles only judge them: those of the last run hold.
struct LedgerMachine {
  std::string identity;  ///< identity of hammer and boom, such as a hash of their parameters; no path, host or time
  std::vector<CountedChannel> channels;
  double equivalent_cycles_per_hour{};
};

/// Channels in the order of LifeRecorder::channels().
LedgerMachine ledgerMachine(const LifeSettings& settings, const std::string& identity);

/// One recording of one machine with one set of sensor parameters.
struct RunId {
  std::string name;          ///< equal whenever this recording is counted, with whatever sensor parameters
  std::string parameters{};  ///< a digest of those of sensors; empty: not known

  RunId(const char* of) : name(of) {}
  RunId(std::string of) : name(std::move(of)) {}
};

/// Slopes at which damage-equivalent loads are given: welded steel, below its knee (DNV-RP-C203), composites.
constexpr double kSlopes[] = {3.0, 4.0, 5.0, 10.0};
constexpr std::size_t kSlopeCount = std::size(kSlopes);

/// Ranges in the channel's unit.
struct ChannelFigures {
  std::array<Figure, kSlopeCount> equivalent_range;  ///< at kSlopes; NaN without any time
  double largest_range{};
  double cycles{};                        ///< half cycles of the residue included
  std::optional<Figure> damage;           ///< by the channel's S-N curve
  std::optional<Figure> remaining_hours;  ///< until the damage is 1
};

/// The figures of a count over some hours.
ChannelFigures figuresOf(const CycleCount& count, const CountedChannel& channel, double hours,
                         double equivalent_cycles_per_hour);

}  // namespace hammer_loads::life
