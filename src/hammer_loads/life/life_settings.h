/// The counted channels, and the S-N lines of their cycles.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hammer_loads/life/damage.h"
#include "hammer_loads/life/load_grid.h"

namespace hammer_loads::life {

/// A load channel, named as the topic and field that publish it.
struct CountedChannel {
  std::string name;  ///< such as section_loads/NAME/torque_y
  LoadGrid grid;
  std::string key{};  ///< short name in the parameter file
};

/// One load's part in a stress.
struct Influence {
  std::string channel;  ///< any channel in use, counted or not
  double factor{};      ///< [MPa per unit of the channel]
};

/// A place whose stress is a sum of loads, formed at each sample and counted as a channel `stress/NAME`.
struct HotSpot {
  std::string name;
  std::vector<Influence> influences;
  LoadGrid grid;                             ///< [MPa]
  std::optional<SnCurve> curve;              ///< without one: damage-equivalent stress ranges alone
  std::optional<FkmMeanStress> mean_stress;  ///< none: the curve is used as it is
};

struct LifeSettings {
  std::vector<CountedChannel> channels;
  std::vector<HotSpot> hot_spots;
  std::int64_t period{};                ///< period of ~load_cycles and the ledger [ns], > 0
  double equivalent_cycles_per_hour{};  ///< reference for damage-equivalent loads, > 0
  std::string ledger;                   ///< file; empty: none is kept
  double bandwidth{};                   ///< frequency up to which the loads are counted [Hz]; 0: all
};

/// `stress/NAME`.
std::string hotSpotChannel(const HotSpot& spot);
/// Name under which a channel is counted: with a bandwidth `NAME_below_FHz`, so that counts of different bands never
/// add.
std::string countedName(const std::string& channel, double bandwidth);

/// Slopes at which damage-equivalent loads are given: welded steel, below its knee (DNV-RP-C203), composites.
constexpr double kSlopes[] = {3.0, 4.0, 5.0, 10.0};

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

}  // namespace hammer_loads::life
