/// process_bag: a recording in, the hammer's loads out.
#include <console_bridge/console.h>

#include <csignal>
#include <filesystem>
#include <iostream>

#include "hammer_loads/commands/bag_options.h"
#include "hammer_loads/commands/output_file.h"
#include "hammer_loads/commands/progress_bar.h"
#include "hammer_loads/life/ledger_run.h"
#include "hammer_loads/ros/bag_inputs.h"
#include "hammer_loads/ros/bag_processing.h"
#include "hammer_loads/tables/table_writer.h"

namespace hammer_loads {
namespace {

struct Arguments {
  std::vector<std::string> bags;  ///< inputs, then the output unless there is none
  std::vector<std::string> params;
  std::string urdf, tables, ledger, reference;
  bool force{}, no_bag{}, replace_run{}, recordings{}, keys{};
};

void addOptions(CommandLine& line, Arguments& given, BagJob& job) {
  line.add_option("bags", given.bags,
                  "IN.bag... OUT.bag: the bags of one recording, then the bag to write, which must not exist")
      ->required()
      ->expected(1, 1000000);
  line.add_flag("--no-bag", given.no_bag, "write no OUT.bag: all bags are inputs");
  line.add_flag("--recordings", given.recordings,
                "write nothing; a line for each bag, in order: number of the recording that it is a split of, name");
  line.add_option("--db", given.tables, "write the results as tables, which must not exist")->type_name("FILE.sqlite");
  line.add_option("--ledger", given.ledger, "add the load cycles to a machine's ledger, unless they are in it")
      ->type_name("FILE.sqlite");
  line.add_flag("--replace-run", given.replace_run, "in the ledger these runs take the place of what it has of them")
      ->needs("--ledger");
  line.add_flag("--force", given.force, "replace OUT.bag and FILE.sqlite if they hold results of this command alone");
  addParamsOption(line, given.params)
      ->description("parameters instead of those of a run_info in the bags; may be repeated");
  addUrdfOption(line, given.urdf);
  for (const InputName& input : kInputs) addTopicOption(line, job.topics, input.topic);
  line.get_option("--pressures-topic")
      ->description("prefix; the topics below it are NAME/bore and NAME/rod per cylinder");
  line.add_option(
          "--reference", given.reference,
          "measured load of the hull: columns stamp [s], force_x, force_z [N], torque_y [N m], any of the last three")
      ->type_name("FILE.csv");
  line.add_flag("--keys", given.keys,
                "on stderr first a line for each warning: its key in the table warnings, a tab, its text");
  line.add_option("--output-prefix", job.output_prefix, "of every topic written")->capture_default_str();
  line.add_flag("--pins", job.pins, "pin forces as well")->excludes("--no-bag");
}

int printRecordings(const std::vector<std::string>& bags) {
  std::size_t number = 0;
  for (const std::vector<std::string>& recording : recordingsOf(bags)) {
    for (const std::string& bag : recording) std::cout << number << ' ' << bag << '\n';
    ++number;
  }
  return finishOutput();
}

/// Errors that the command line alone shows; empty: nothing.
std::string usageProblem(const Arguments& given) {
  if (given.recordings) return {};
  if (given.no_bag && given.tables.empty() && given.ledger.empty())
    return "--no-bag: nothing would be written, --db or --ledger FILE.sqlite is required";
  if (!given.no_bag && given.bags.size() < 2) return "bags: IN.bag... and OUT.bag are required, or --no-bag";
  const auto whole = [](const std::string& name) { return std::filesystem::weakly_canonical(name); };
  if (!given.no_bag && !given.tables.empty() && whole(given.tables) == whole(given.bags.back()))
    return "--db: " + given.tables + ", must be another file than OUT.bag";
  const std::string other = given.no_bag ? given.tables : given.bags.back();
  for (const std::string& output : {given.tables, other}) {
    if (!given.ledger.empty() && !output.empty() && whole(given.ledger) == whole(output))
      return "--ledger: " + given.ledger + ", must be another file than " + output;
  }
  return {};
}

/// Reason why an existing bag must stay; empty: it is an output and none of the job's inputs.
std::string whyOutputMustStay(const std::string& name, const BagJob& job) {
  std::vector<std::string> topics;
  for (const InputName& input : kInputs) {
    const std::string& topic = job.topics.*input.topic;
    topics.push_back(topic.empty() ? input.recorded : topic);
  }
  return whyBagMustStay(name, topics);
}

/// Problems; runs that are not counted again are warnings.
std::vector<std::string> writeLedger(life::LedgerBatch& ledger, BagReport& report) {
  std::vector<std::string> known;
  const std::string problem = ledger.write(known);
  for (const std::string& line : known) addOnce(report.warnings, {"ledger", line});
  if (problem.empty()) return {};
  return {problem};
}

/// Takes the files, processes, gives them their names. Returns the problems, one line each.
std::vector<std::string> process(const Arguments& given, BagJob& job, BagReport& report) {
  std::vector<OutputFile> files;
  std::vector<std::string> problems;
  const auto take = [&](const std::string& name, std::string& path, const auto& why_it_must_stay) {
    Checked<OutputFile> file = OutputFile::make({name, job.inputs, given.force, why_it_must_stay});
    problems = file.problems;
    if (!file.value) return;
    path = file.value->path();
    files.push_back(*std::move(file.value));
  };
  if (!given.tables.empty()) take(given.tables, job.tables, whyTablesMustStay);
  if (!given.no_bag && problems.empty())
    take(given.bags.back(), job.output, [&job](const std::string& name) { return whyOutputMustStay(name, job); });
  if (!problems.empty()) return problems;
  std::optional<life::LedgerBatch> ledger;
  if (!given.ledger.empty()) {
    ledger.emplace(given.ledger, given.replace_run);
    const std::string problem = ledger->check();
    if (!problem.empty()) return {problem};
    job.pieces = &*ledger;
  }
  ProgressBar bar;
  problems = processBag(job, std::ref(bar), report);
  for (std::string& problem : problems) {
    for (const OutputFile& file : files)
      if (problem.rfind(file.path() + ":", 0) == 0) problem.replace(0, file.path().size(), file.name());
  }
  if (ledger && problems.empty()) problems = writeLedger(*ledger, report);
  for (const OutputFile& file : files) {
    const std::string problem = problems.empty() ? file.sync() : "";
    if (!problem.empty()) problems.push_back(problem);
  }
  // Together: no signal may part them. The ledger comes first: a commit can fail, and then no file has its name yet.
  sigset_t all, before;
  sigfillset(&all);
  sigprocmask(SIG_BLOCK, &all, &before);
  std::string problem;
  if (ledger && problems.empty()) problem = ledger->commit();
  for (OutputFile& file : files)
    if (problems.empty() && problem.empty()) problem = file.publish();
  if (!problem.empty()) problems.push_back(problem);
  files.clear();
  sigprocmask(SIG_SETMASK, &before, nullptr);
  return problems;
}

/// Returns what is wrong with the file of a measured load.
std::vector<std::string> readReference(const std::string& file, BagJob& job) {
  if (file.empty()) return {};
  const Checked<std::string> text = fileText(file);
  if (!text.value) return text.problems;
  Checked<std::vector<MeasuredLoad>> rows = readReferenceTable(*text.value);
  for (std::string& problem : rows.problems) problem.insert(0, file + ": ");
  if (rows.value) job.reference = *std::move(rows.value);
  return rows.problems;
}

int run(int argc, const char* const* argv) {
  console_bridge::setLogLevel(console_bridge::CONSOLE_BRIDGE_LOG_ERROR);  // rosbag formats a line for every message
  CommandLine line("Loads of the hammer from a recorded bag", "process_bag");
  Arguments given;
  BagJob job;
  addOptions(line, given, job);
  if (const auto code = line.parse(argc, argv)) return *code;
  const std::string usage = usageProblem(given);
  if (!usage.empty()) {
    std::cerr << "process_bag: " << usage << " (--help shows the options)\n";
    return kExitWrongUsage;
  }
  if (given.recordings) return printRecordings(given.bags);
  endCleanlyOnSignals();
  job.inputs.assign(given.bags.begin(), given.bags.end() - (given.no_bag ? 0 : 1));
  const std::vector<std::string> bad_files = readParameterFiles(given.params, given.urdf, job);
  if (!bad_files.empty()) return fail(bad_files);
  const std::vector<std::string> bad_rows = readReference(given.reference, job);
  if (!bad_rows.empty()) return fail(bad_rows);

  BagReport report;
  const std::vector<std::string> problems = process(given, job, report);
  for (const BagWarning& warning : report.warnings)
    if (given.keys) std::cerr << warning.key << '\t' << warning.text << '\n';
  if (!problems.empty()) return fail(problems);
  for (const std::string& note : report.notes) std::cerr << "note: " << note << '\n';
  std::cerr << textOf(report);
  for (const std::string& warning : textsOf(report.warnings)) std::cerr << "warning: " << warning << '\n';
  const std::string& results = given.tables.empty() ? given.ledger : given.tables;
  std::cout << (given.no_bag ? results : given.bags.back()) << ": " << summaryOf(report) << std::endl;
  return 0;
}

}  // namespace
}  // namespace hammer_loads

int main(int argc, char** argv) { return hammer_loads::run(argc, argv); }
