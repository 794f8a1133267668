/// process_bag: a recorded bag in, the hammer's loads out.
#include <unistd.h>

#include <cstdio>
#include <iostream>

#include "hammer_loads/parameters/command_line.h"
#include "hammer_loads/ros/bag_processing.h"

namespace hammer_loads {
namespace {

/// Drawn on a terminal only, once per percent.
class ProgressBar {
 public:
  void operator()(double part) {
    const int percent = static_cast<int>(100.0 * part);
    if (!terminal_ || percent == last_) return;
    last_ = percent;
    std::fprintf(stderr, "\r[%-50.*s] %3d %%%s", percent / 2, "##################################################",
                 percent, percent == 100 ? "\n" : "");
  }

 private:
  bool terminal_{isatty(STDERR_FILENO) == 1};
  int last_{-1};
};

int run(int argc, const char* const* argv) {
  CLI::App app("Loads of the hammer from a recorded bag", "process_bag");
  BagJob job;
  std::vector<std::string> files;
  app.add_option("input", job.input, "bag to read")->required();
  app.add_option("output", job.output, "bag to write")->required();
  addParamsOption(app, files);
  app.add_option("--crank-topic", job.crank_topic)->capture_default_str();
  app.add_option("--joint-states-topic", job.joint_topic)->capture_default_str();
  app.add_option("--output-prefix", job.output_prefix, "of every topic written")->capture_default_str();
  app.add_flag("--pins", job.pins, "pin forces as well");
  if (const auto code = parse(app, argc, argv)) return *code;
  const std::optional<Settings> settings = loadOrReport(files);
  if (!settings) return kExitFailure;

  ProgressBar bar;
  IntakeCounts counts;
  const std::string problem = processBag(job, *settings, std::ref(bar), counts);
  if (!problem.empty()) {
    std::cerr << problem << '\n';
    return kExitFailure;
  }
  for (std::size_t i = 0; i < counts.refused.size(); ++i) {
    if (counts.refused[i] > 0) std::cerr << "crank samples without a wrench, " << kRefusalNames[i] << ": " << counts.refused[i] << '\n';
  }
  return 0;
}

}  // namespace
}  // namespace hammer_loads

int main(int argc, char** argv) { return hammer_loads::run(argc, argv); }
