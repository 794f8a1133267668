// Rows as written to a table.
#include "hammer_loads/tables/table_writer.h"

#include <gtest/gtest.h>

#include <limits>
#include <optional>

#include "hammer_loads/tables/digest.h"
#include "settings/temporary_file.h"

namespace hammer_loads {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity(), kNone = std::numeric_limits<double>::quiet_NaN();

std::vector<std::string> rowsOf(const std::string& file, const char* sql) {
  life::Database database(file, life::Database::Use::kRead, 0);
  life::Database::Statement rows(database, sql);
  std::vector<std::string> texts;
  while (rows.step()) texts.push_back(rows.text(0));
  EXPECT_EQ(database.problem(), "");
  return texts;
}

/// Values without a measurement are NULL, which is not zero.
TEST(TableWriter, WritesNullForWhatIsNotKnown) {
  const test::TemporaryFile file("");
  const std::vector<TableColumn> columns{{"turn", true, "-", {}}, {"flags", true, "-", {}}, {"energy", false, "J", {}}};
  {
    TableWriter writer(file.path(), columns, columns);
    writer.add("boom_cylinders", 1, 7U, "arm_cylinder", -0.5, std::optional<double>(0.9), kInf, true);
    writer.add("boom_modes", std::int64_t{1}, std::uint64_t{7}, 2, 8.5, std::optional<double>(), 0.05, kNone);
    writer.add("channels(run_id, channel, name)", 1, 0, std::string("it's"));
    writer.addTurn("blows", 1, 1700000000000000001, {3.0, 4.0, kNone});
    writer.finish();
    ASSERT_EQ(writer.problem(), "");
  }
  const auto row = [&](const char* sql) { return rowsOf(file.path(), sql); };
  using Rows = std::vector<std::string>;
  EXPECT_EQ(row("SELECT run_id || '|' || turn || '|' || cylinder || '|' || joint_angle || '|' || stiffness_ratio || "
                "'|' || doubtful FROM "
                "boom_cylinders WHERE stiffness_ratio_std IS NULL"),
            Rows{"1|7|arm_cylinder|-0.5|0.9|1"});
  EXPECT_EQ(row("SELECT turn || '|' || mode || '|' || frequency || '|' || damping_ratio FROM boom_modes WHERE "
                "frequency_std IS NULL AND damping_ratio_std IS NULL"),
            Rows{"7|2|8.5|0.05"});
  EXPECT_EQ(row("SELECT name FROM channels WHERE unit IS NULL AND classes IS NULL"), Rows{"it's"});
  EXPECT_EQ(row("SELECT turn || '|' || stamp_ns || '|' || flags FROM blows WHERE energy IS NULL"),
            Rows{"3|1700000000000000001|4"});
}

TEST(Sha256, DistinguishesWhereATextEnds) {
  EXPECT_NE(sha256Of({"ab", "c"}), sha256Of({"a", "bc"}));
  EXPECT_NE(sha256Of({"abc"}), sha256Of({"abc", ""}));
}

}  // namespace
}  // namespace hammer_loads
