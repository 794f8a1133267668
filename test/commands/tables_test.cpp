/// The tables of process_bag --db agree with the output bag and the console.

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "commands/bag_tables.h"
#include "hammer_loads/Alarms.h"
#include "hammer_loads/Blow.h"
#include "hammer_loads/HullLoads.h"
#include "hammer_loads/LoadCycles.h"
#include "hammer_loads/Pulse.h"
#include "hammer_loads/TurnLoads.h"

namespace hammer_loads {
namespace {

using test::contentOf;
using test::kSession;
using test::Tables;

/// Compares column by column with what a reader of the bag sees. NaN is NULL.
TEST_F(Tables, EqualTheOutputBag) {
  const test::Outcome outcome = run(kSession + " " + path("out.bag") + " --db " + path("out.sqlite"));
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  Database database(path("out.sqlite"), Database::Use::kRead, 0);
  Database::Statement turns(database, "SELECT stamp_ns, amplitude, turn, half_sine_rms_error FROM turns");
  Database::Statement blows(database, "SELECT stamp_ns, energy, turn, mean_hold_down_force, flags FROM blows");
  const auto expect_row = [](Database::Statement& row, const ros::Time& stamp, double value, std::uint64_t turn,
                             double last) {
    ASSERT_TRUE(row.step());
    EXPECT_EQ(row.integer(0), static_cast<std::int64_t>(stamp.toNSec()));
    EXPECT_EQ(row.number(1), value);
    EXPECT_EQ(row.integer(2), static_cast<std::int64_t>(turn));
    EXPECT_TRUE(std::isnan(last) ? row.isNull(3) : row.number(3) == last);
  };
  std::uint64_t samples = 0, not_known = 0;
  rosbag::Bag bag(path("out.bag"));
  for (const rosbag::MessageInstance& item : rosbag::View(bag)) {
    if (const auto p = item.instantiate<Pulse>())
      expect_row(turns, p->header.stamp, p->amplitude, p->turn, p->half_sine_rms_error);
    if (const auto b = item.instantiate<Blow>()) {
      expect_row(blows, b->header.stamp, b->energy, b->turn, b->mean_hold_down_force);
      EXPECT_EQ(blows.integer(4), b->flags);
      not_known += std::isnan(b->mean_hold_down_force);
    }
    samples += item.isType<HullLoads>();
  }
  EXPECT_FALSE(turns.step());
  EXPECT_FALSE(blows.step());
  EXPECT_GT(not_known, 0U);
  EXPECT_EQ(number("out.sqlite", "SELECT published FROM runs"), static_cast<double>(samples));
  EXPECT_EQ(number("out.sqlite", "SELECT turns FROM runs"), number("out.sqlite", "SELECT count(*) FROM turns"));
  EXPECT_EQ(number("out.sqlite", "SELECT blows FROM runs"), number("out.sqlite", "SELECT count(*) FROM blows"));
  EXPECT_NEAR(number("out.sqlite", "SELECT duration FROM runs"), 29.8, 0.2);
}

/// Loads of revolutions and counted cycles agree with their messages.
TEST_F(Tables, KnowTheLoadsOfTurnsAndTheirCycles) {
  ASSERT_EQ(run(kSession + " " + path("out.bag") + " --db " + path("out.sqlite")).exit_code, 0);
  TurnLoads turn;
  LoadCycles cycles;
  std::size_t whole = 0;
  rosbag::Bag bag(path("out.bag"));
  for (const rosbag::MessageInstance& item : rosbag::View(bag)) {
    if (const auto t = item.instantiate<TurnLoads>(); t && t->whole) turn = *t, ++whole;
    if (const auto c = item.instantiate<LoadCycles>()) cycles = *c;
  }
  ASSERT_GT(whole, 100U);
  ASSERT_FALSE(cycles.channel.empty());
  EXPECT_EQ(number("out.sqlite", "SELECT count(*) FROM turn_loads"), static_cast<double>(whole * turn.channel.size()));
  for (std::size_t i = 0; i < turn.channel.size(); ++i) {
    const std::string where = " FROM turn_loads t JOIN channels USING(run_id, channel) WHERE name = '" +
                              turn.channel[i] + "' AND turn = " + std::to_string(turn.turn);
    EXPECT_EQ(number("out.sqlite", "SELECT t.maximum" + where), turn.maximum[i]) << turn.channel[i];
    EXPECT_EQ(number("out.sqlite", "SELECT t.mean" + where), turn.mean[i]) << turn.channel[i];
  }
  EXPECT_EQ(ask("out.sqlite", "SELECT unit FROM channels WHERE name = 'hull_wrench/torque_y'"),
            std::vector<std::string>{"N m"});
  for (const ChannelCycles& channel : cycles.channel) {
    const auto of_channel = [&](const std::string& table) {
      return " FROM " + table + " JOIN channels c USING(run_id, channel) WHERE c.counted AND name = '" + channel.name +
             "'";
    };
    EXPECT_EQ(number("out.sqlite", "SELECT samples FROM channels WHERE name = '" + channel.name + "'"),
              static_cast<double>(channel.samples));
    EXPECT_EQ(number("out.sqlite", "SELECT sum(count)" + of_channel("cycles")),
              static_cast<double>(std::accumulate(channel.count.begin(), channel.count.end(), std::uint64_t{0})));
    std::vector<std::string> residue;
    for (const std::uint32_t turning_point : channel.residue) residue.push_back(std::to_string(turning_point));
    EXPECT_EQ(ask("out.sqlite", "SELECT class" + of_channel("residues") + " ORDER BY place"), residue);
  }
}

/// Each alarm of the output bag lasts from its first message to the last of its level.
TEST_F(Tables, HoldTheAlarms) {
  const test::TemporaryFile limits(
      "limit_blow_energy_least_warn_J: 980.0\nlimit_blow_energy_greatest_warn_J: 1020.0\n"
      "limit_hold_down_force_error_N: 1.0\n");
  ASSERT_EQ(
      run(kSession + " " + path("out.bag") + " --db " + path("out.sqlite") + " --params " + limits.path()).exit_code,
      0);
  std::map<std::pair<std::string, std::uint64_t>, std::vector<Alarm>> alarms;  // by name and beginning
  rosbag::Bag bag(path("out.bag"));
  for (const rosbag::MessageInstance& item : rosbag::View(bag)) {
    const auto message = item.instantiate<Alarms>();
    if (!message) continue;
    for (const Alarm& alarm : message->alarm) alarms[{alarm.name, alarm.since.toNSec()}].push_back(alarm);
  }
  ASSERT_GT(alarms.size(), 3U);
  EXPECT_EQ(number("out.sqlite", "SELECT count(*) FROM alarms"), static_cast<double>(alarms.size()));
  for (const auto& [key, seen] : alarms) {
    const std::string where =
        " FROM alarms WHERE name = '" + key.first + "' AND since_ns = " + std::to_string(key.second);
    const auto beyond = [](const Alarm& a, const Alarm& b) {
      return std::abs(a.value - a.limit) < std::abs(b.value - b.limit);
    };
    const Alarm& farthest = *std::max_element(seen.begin(), seen.end(), beyond);
    EXPECT_EQ(number("out.sqlite", "SELECT turns" + where), static_cast<double>(seen.size()));
    EXPECT_EQ(number("out.sqlite", "SELECT value" + where), farthest.value);
    EXPECT_EQ(number("out.sqlite", "SELECT value_std" + where), farthest.value_std);
    EXPECT_EQ(number("out.sqlite", "SELECT level" + where), farthest.level);
  }
}

TEST_F(Tables, KnowInputParametersAndMachine) {
  const test::TemporaryFile level("level: rocker\n");
  const test::TemporaryFile paths("log_directory: /tmp/a node's\nlog_split_mb: 77\nlife_ledger: /tmp/a.sqlite\n");
  ASSERT_EQ(tables(kSession, "shipped.sqlite").exit_code, 0);
  ASSERT_EQ(tables(kSession, "level.sqlite", "--params " + level.path()).exit_code, 0);
  ASSERT_EQ(tables(kSession, "paths.sqlite", "--params " + paths.path()).exit_code, 0);
  const std::string sha = test::runCommand("sha256sum", kSession).out.substr(0, 64);
  EXPECT_EQ(ask("shipped.sqlite", "SELECT input_sha256 FROM runs"), std::vector<std::string>{sha});
  const auto both = [&](const char* column) {
    const std::string sql = std::string("SELECT ") + column + " FROM runs";
    return std::make_pair(ask("shipped.sqlite", sql), ask("level.sqlite", sql));
  };
  EXPECT_EQ(both("machine").first, both("machine").second);
  EXPECT_NE(both("parameters_sha256").first, both("parameters_sha256").second);
  EXPECT_NE(both("run_key").first, both("run_key").second);
  const std::string changed = "SELECT key || ' ' || value || ' ' || shipped FROM parameters WHERE value <> shipped";
  EXPECT_EQ(ask("shipped.sqlite", changed), std::vector<std::string>{});
  EXPECT_EQ(ask("level.sqlite", changed), std::vector<std::string>{"level rocker linkage"});
  EXPECT_EQ(ask("level.sqlite", "SELECT level FROM runs"), std::vector<std::string>{"rocker"});
  EXPECT_EQ(ask("shipped.sqlite", "SELECT value FROM parameters WHERE key = 'pitch_joints'"),
            std::vector<std::string>{"[boom_joint, arm_joint, hammer_joint]"});
  const std::string yaml = ask("shipped.sqlite", "SELECT parameters_yaml FROM runs").at(0);
  EXPECT_NE(yaml.find("crank_length_m: "), std::string::npos);
  for (const char* part : {"/tmp", ".bag", "mo100_100hz"})
    EXPECT_EQ(contentOf(path("shipped.sqlite")).find(part), std::string::npos) << part;
  // Paths of log and ledger are among a log's parameters but are no property of the machine.
  EXPECT_EQ(contentOf(path("paths.sqlite")).find("/tmp"), std::string::npos);
  const std::string hash = "SELECT parameters_sha256 FROM runs";
  EXPECT_EQ(ask("paths.sqlite", hash), ask("shipped.sqlite", hash));
}

TEST_F(Tables, RefusalsAndWarningsAreThoseOnTheConsole) {
  {
    rosbag::Bag bag(path("in.bag"), rosbag::bagmode::Write);
    test::forEachOfSession([&](const rosbag::MessageInstance& item) {
      if (item.getTopic() == "/joint_states") return;
      bag.write(item.getTopic(), item.getTime(), item);
      if (item.getTime().toSec() - 1.7e9 > 10.0 && item.getTime().toSec() - 1.7e9 < 10.1)
        bag.write(item.getTopic(), item.getTime(), item);  // as often as there are samples in 0.1 s
    });
  }
  const test::Outcome outcome = tables(path("in.bag"), "out.sqlite");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const std::vector<std::string> refused = ask("out.sqlite",
                                               "SELECT reason || ': ' || count FROM refusals "
                                               "WHERE reason != 'beside the blow'");
  ASSERT_EQ(refused.size(), 1U);
  EXPECT_NE(outcome.err.find("crank samples without a wrench, " + refused[0] + "\n"), std::string::npos) << outcome.err;
  const std::vector<std::string> warnings = ask("out.sqlite", "SELECT text FROM warnings ORDER BY place");
  ASSERT_GE(warnings.size(), 2U);
  for (const std::string& text : warnings) EXPECT_NE(outcome.err.find("warning: " + text), std::string::npos) << text;
}

TEST_F(Tables, TracesAreSamplesOfTheirTurn) {
  ASSERT_EQ(tables(kSession, "out.sqlite").exit_code, 0);
  EXPECT_EQ(ask("out.sqlite", "SELECT DISTINCT kind FROM traces ORDER BY kind"),
            (std::vector<std::string>{"typical", "worst"}));
  EXPECT_EQ(ask("out.sqlite", "SELECT DISTINCT turn FROM traces WHERE kind = 'worst'"),
            ask("out.sqlite", "SELECT turn FROM turns ORDER BY amplitude DESC LIMIT 1"));
  // The typical revolution's amplitude lies in the middle half of all.
  EXPECT_NEAR(number("out.sqlite",
                     "SELECT avg(t.amplitude <= (SELECT amplitude FROM turns WHERE turn = "
                     "(SELECT turn FROM traces WHERE kind = 'typical'))) FROM turns t"),
              0.5, 0.25);
  for (const char* kind : {"typical", "worst"}) {
    const std::string of_kind = std::string(" FROM traces JOIN turns USING(run_id, turn) WHERE kind = '") + kind + "'";
    EXPECT_EQ(number("out.sqlite", "SELECT sum(time <= 0.0 OR time > period)" + of_kind), 0.0);
    // Samples are 10 ms apart. None exceeds the peak, which is found between samples.
    EXPECT_NEAR(number("out.sqlite", "SELECT count(*) * 0.01 - period" + of_kind), 0.0, 0.011);
    EXPECT_LE(number("out.sqlite", "SELECT max(force_z) / amplitude" + of_kind), 1.0 + 1e-9);
    EXPECT_GT(number("out.sqlite", "SELECT max(force_z) / amplitude" + of_kind), 0.5);
  }
}

/// Each run_info of a node is a run with its own parameters.
TEST_F(Tables, EachRunInfoIsARow) {
  ASSERT_EQ(run(kSession + " " + path("first.bag")).exit_code, 0);
  RunInfo info;
  rosbag::Bag made(path("first.bag"));
  for (const rosbag::MessageInstance& item : rosbag::View(made, rosbag::TopicQuery("/hammer_loads/run_info")))
    info = *item.instantiate<RunInfo>();
  {
    rosbag::Bag bag(path("log.bag"), rosbag::bagmode::Write);
    int i = 0;
    test::forEachOfSession([&](const rosbag::MessageInstance& item) {
      if (i == 0 || i == 2000) {
        info.header.stamp = item.getTime();
        const std::size_t level = info.parameters_yaml.find("level: ");
        const std::size_t end = info.parameters_yaml.find('\n', level);
        info.parameters_yaml.replace(level, end - level, i == 0 ? "level: \"rocker\"" : "level: \"linkage\"");
        bag.write("/node/run_info", item.getTime(), info);
      }
      ++i;
      bag.write(item.getTopic(), item.getTime(), item);
    });
  }
  const test::Outcome outcome = tables(path("log.bag"), "out.sqlite");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(ask("out.sqlite", "SELECT run_id || ' ' || level FROM runs ORDER BY run_id"),
            (std::vector<std::string>{"1 rocker", "2 linkage"}));
  EXPECT_EQ(ask("out.sqlite", "SELECT count(DISTINCT run_key) FROM runs"), std::vector<std::string>{"2"});
  for (const char* table : {"turns", "blows", "parameters", "traces"})
    EXPECT_EQ(ask("out.sqlite", std::string("SELECT DISTINCT run_id FROM ") + table + " ORDER BY 1"),
              (std::vector<std::string>{"1", "2"}))
        << table;
}

}  // namespace
}  // namespace hammer_loads
