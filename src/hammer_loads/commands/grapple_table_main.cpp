/// grapple_table: path of the right jaw's edge over the slider position, as CSV or as design figures.
#include <cmath>
#include <iostream>

#include "hammer_loads/commands/command_line.h"
#include "hammer_loads/grapple/grapple_table.h"
#include "hammer_loads/settings/read_grapple.h"

namespace hammer_loads {
namespace {

int run(int argc, const char* const* argv) {
  CLI::App app("Path of the grapple's right jaw edge over the slider position", "grapple_table");
  std::vector<std::string> files;
  TableRequest request;
  addParamsOption(app, files);
  app.get_option("--params")->required()->description("the grapple; may be repeated, the last one wins");
  const CLI::Validator metres = numberWithin(-HUGE_VAL, HUGE_VAL, "m");
  app.add_option("--from", request.from, "slider position of the first row [m]; default: closed")->check(metres);
  app.add_option("--to", request.to, "slider position of the last row [m]; default: open")->check(metres);
  auto* steps = app.add_option("--steps", request.steps, "equidistant steps between them; one row more than that");
  steps->check(CLI::Range(1, 1000000000))->type_name("INT");
  auto* summary = app.add_flag("--summary", request.summary, "design figures of the path instead of the table");
  auto* opening = app.add_option("--opening", request.opening, "one row, at this distance between the jaw edges [m]");
  opening->check(metres)->excludes("--from", "--to", "--steps", "--summary");
  if (const auto code = parse(app, argc, argv)) return *code;
  if (steps->count() + summary->count() + opening->count() == 0) {
    std::cerr << "grapple_table: --steps, --summary or --opening is required (--help shows the options)\n";
    return kExitWrongUsage;
  }

  const Checked<Grapple> grapple = loadGrapple(files);
  for (const std::string& problem : grapple.problems) std::cerr << problem << '\n';
  if (!grapple.value) return kExitFailure;
  const std::optional<std::string> problem = printTable(*grapple.value, request, std::cout);
  if (problem) std::cerr << *problem << '\n';
  if (problem) return kExitFailure;
  return finishOutput();
}

}  // namespace
}  // namespace hammer_loads

int main(int argc, char** argv) { return hammer_loads::run(argc, argv); }
