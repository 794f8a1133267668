/// grapple_table: path of the right jaw's edge over the slider position, as CSV or as design figures.
#include <iostream>

#include "hammer_loads/commands/command_line.h"
#include "hammer_loads/grapple/grapple_table.h"
#include "hammer_loads/grapple/read_grapple.h"
#include "hammer_loads/util/constants.h"

namespace hammer_loads {
namespace {

int run(int argc, const char* const* argv) {
  CommandLine line("Path of the grapple's right jaw edge over the slider position", "grapple_table");
  std::vector<std::string> files;
  TableRequest request;
  addParamsOption(line, files);
  line["--params"].required().description("the grapple; may be repeated, the last one wins");
  const auto metres = [&](const char* name, std::optional<double>& value, const char* help) {
    return line.option(name, value, help).within(-kInfinity, kInfinity, "m");
  };
  metres("--from", request.from, "slider position of the first row [m]; default: closed");
  metres("--to", request.to, "slider position of the last row [m]; default: open");
  const Option steps = line.option("--steps", request.steps, "equidistant steps between them; one row more than that")
                           .withinIntegers(1, 1000000000)
                           .type("INT");
  const Option summary = line.flag("--summary", request.summary, "design figures of the path instead of the table");
  const Option opening = metres("--opening", request.opening, "one row, at this distance between the jaw edges [m]")
                             .excludes({"--from", "--to", "--steps", "--summary"});
  if (const auto code = line.parse(argc, argv)) return *code;
  if (!steps.given() && !summary.given() && !opening.given()) {
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
