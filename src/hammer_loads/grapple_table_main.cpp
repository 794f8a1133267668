/// grapple_table: path of the right jaw's edge over the slider position, as CSV or as design figures.
#include <iostream>
#include <limits>

#include "hammer_loads/grapple/design_figures.h"
#include "hammer_loads/grapple/read_grapple.h"
#include "hammer_loads/parameters/command_line.h"

namespace hammer_loads {
namespace {

/// False after a line on stderr when there is no pose.
bool printRows(const Grapple& grapple, double from, double to, int steps) {
  std::cout << motionCsvHeader() << '\n';
  std::optional<GrappleMotion> motion;
  for (int i = 0; i <= steps && std::cout; ++i) {
    const double slider = i == 0 ? from : i == steps ? to : from + (to - from) * i / steps;
    motion = motion ? grapple.follow(*motion, slider) : grapple.at(slider);
    if (!motion) std::cerr << grapple.explain(Refusal::kNotFound, slider) << '\n';
    if (!motion) return false;
    std::cout << motionCsvLine(*motion) << '\n';
  }
  return true;
}

int run(int argc, const char* const* argv) {
  CLI::App app("Path of the grapple's right jaw edge over the slider position", "grapple_table");
  std::vector<std::string> files;
  double from = 0.0, to = 0.0;
  int steps = 0;
  bool summary = false;
  addParamsOption(app, files);
  app.get_option("--params")->required()->description("the grapple; may be repeated, the last one wins");
  const CLI::Validator metres = numberWithin(-HUGE_VAL, HUGE_VAL, "m");
  auto* first = app.add_option("--from", from, "slider position of the first row [m]; default: closed")->check(metres);
  auto* last = app.add_option("--to", to, "slider position of the last row [m]; default: open")->check(metres);
  auto* rows = app.add_option("--steps", steps, "steps between: one row more")->check(CLI::Range(1, 1000000000));
  app.add_flag("--summary", summary, "print the design figures of the path instead of the table");
  if (const auto code = parse(app, argc, argv)) return *code;
  if (!summary && rows->count() == 0) return wrongUsage("--steps or --summary is required");

  const Checked<Grapple> grapple = loadGrapple(files);
  for (const std::string& problem : grapple.problems) std::cerr << problem << '\n';
  if (!grapple.value) return kExitFailure;
  if (first->count() == 0) from = grapple.value->parameters().slider_closed;
  if (last->count() == 0) to = grapple.value->parameters().slider_open;
  for (const auto& [name, slider] : {std::pair{"--from", from}, std::pair{"--to", to}}) {
    const Refusal refusal = grapple.value->judge(slider);
    if (refusal == Refusal::kNone) continue;
    std::cerr << grapple.value->explain(refusal, slider, name) << '\n';
    return kExitFailure;
  }
  if (summary) std::cout << summaryText(*grapple.value, designFigures(*grapple.value, from, to));
  if (!summary && !printRows(*grapple.value, from, to, steps)) return kExitFailure;
  if (std::cout.flush()) return 0;
  std::cerr << "stdout: cannot be written\n";
  return kExitFailure;
}

}  // namespace
}  // namespace hammer_loads

int main(int argc, char** argv) { return hammer_loads::run(argc, argv); }
