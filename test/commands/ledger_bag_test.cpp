/// process_bag --ledger: additions, refusals and what stays unchanged.
#include "commands/bag_files.h"
#include "hammer_loads/life/ledger_reader.h"
#include "hammer_loads/settings/load.h"
#include "support/known_zero.h"

namespace hammer_loads {
namespace {

namespace fs = std::filesystem;
using test::contentOf;
using test::kSession;
using test::linesOf;

class LedgerOfBags : public test::BagFiles {
 protected:
  std::string ledger() const { return path("machine.sqlite"); }
  test::Outcome add(const std::string& bags, const std::string& more = {}) const {
    return run("--no-bag " + bags + " --ledger " + ledger() + " " + more);
  }
  std::vector<life::LedgerEpoch> epochs() const { return life::LedgerReader(ledger()).epochs(); }
};

TEST_F(LedgerOfBags, HasEachRecordingOnce) {
  std::ofstream(path("known_zero.yaml")) << kKnownZeroYaml;
  for (const std::size_t times : {0U, 1U}) {
    const test::Outcome outcome = add(kSession, "--params " + path("known_zero.yaml"));
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(outcome.err.find("not counted again") != std::string::npos, times > 0) << outcome.err;
    ASSERT_EQ(epochs().size(), 1U);
    EXPECT_EQ(epochs()[0].runs, 1U);
    EXPECT_EQ(epochs()[0].days.at(0).turns, 122U);
    EXPECT_NEAR(1e-9 * static_cast<double>(epochs()[0].days[0].duration), 30.0, 0.2);
  }
  EXPECT_EQ(add(std::string(HAMMER_LOADS_TEST_DATA) + "/mo100_1khz.bag").exit_code, 0);
  EXPECT_EQ(epochs().at(0).runs, 2U);
  EXPECT_EQ(epochs().at(0).days.at(0).turns, 122U + 76U);
}

/// The machine starts at 2 s and strikes four times a second, so eight revolutions end at 4 s.
TEST_F(LedgerOfBags, CountsNothingBeforeTheZeroIsKnown) {
  EXPECT_EQ(add(kSession).exit_code, 0);
  EXPECT_NEAR(1e-9 * static_cast<double>(epochs().at(0).days.at(0).duration), 26.0, 1.0);
}

TEST_F(LedgerOfBags, AnotherMachineBeginsAnotherEpoch) {
  EXPECT_EQ(add(kSession).exit_code, 0);
  std::ofstream(path("scale.yaml")) << "life_classes: 1024\n";
  EXPECT_EQ(add(kSession, "--params " + path("scale.yaml")).exit_code, 0);
  EXPECT_EQ(epochs().size(), 1U) << "the same run, whatever the grid";
  std::ofstream hammer(path("hammer.yaml"));
  for (const std::string& line : linesOf(contentOf(configDirectory() + "/hammer_mo100.yaml")))
    hammer << (line.rfind("rocker_mass_kg", 0) == 0 ? "rocker_mass_kg: 35.3" : line) << '\n';
  hammer.close();
  const test::Outcome outcome = add(kSession, "--params " + path("hammer.yaml"));
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(epochs().size(), 2U);
}

TEST_F(LedgerOfBags, LeavesAFileThatIsNoLedgerAndGivesNoOutput) {
  const std::string text = "a text that is no ledger, and long enough to be taken for a file of some other kind\n";
  std::ofstream(ledger()) << text;
  expectRefused(run(kSession + " " + path("out.bag") + " --ledger " + ledger()), {ledger()});
  EXPECT_EQ(contentOf(ledger()), text);
  fs::remove(ledger());
  fs::create_directory(ledger());
  expectRefused(add(kSession), {ledger(), "no regular file"});
  expectRefused(run("--no-bag " + kSession + " --ledger " + path("no/such/ledger.sqlite")), {"no/such/ledger.sqlite"});
  EXPECT_FALSE(fs::exists(path("out.bag")));
}

TEST_F(LedgerOfBags, RefusesTheNameOfAnotherOutput) {
  for (const std::string& arguments :
       {kSession + " " + path("a.bag") + " --ledger " + path("a.bag"),
        "--no-bag " + kSession + " --db " + path("a.sqlite") + " --ledger " + path("./a.sqlite")}) {
    const test::Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_NE(outcome.err.find("must be another file"), std::string::npos) << outcome.err;
  }
  EXPECT_EQ(names(), std::vector<std::string>{});
}

TEST_F(LedgerOfBags, ARecordingWithoutAWrenchAddsNothing) {
  EXPECT_EQ(add(kSession, "--crank-topic /joint_states").exit_code, 1);
  EXPECT_FALSE(fs::exists(ledger()));
}

}  // namespace
}  // namespace hammer_loads
