/// grapple_table: path of the right jaw's edge over the slider position, as CSV or as design figures.
#include <iostream>

#include "hammer_loads/commands/command_line.h"
#include "hammer_loads/grapple/grapple_settings.h"
#include "hammer_loads/grapple/grapple_table.h"
#include "hammer_loads/util/constants.h"

namespace hammer_loads {
namespace {

int run(int argc, const char* const* argv) {
  CommandLine line("Path of the grapple's right jaw edge over the slider position", "grapple_table");
  std::vector<std::string> files;
  TableRequest request;
  addParamsOption(line, files)->required()->description("the grapple; may be repeated, the last one wins");
  const auto metres = [&](const char* name, std::optional<double>& value, const char* help) {
    return line.add_option(name, value, help)->check(within(-kInfinity, kInfinity, "m"));
  };
  metres("--from", request.from, "slider position of the first row [m]; default: closed");
  metres("--to", request.to, "slider position of the last row [m]; default: open");
  const CLI::Option* steps =
      line.add_option("--steps", request.steps, "equidistant steps between them; one row more than that")
          ->check(CLI::Range(std::int64_t{1}, std::int64_t{1000000000}))
          ->type_name("INT");
  const CLI::Option* summary =
      line.add_flag("--summary", request.summary, "design figures of the path instead of the table");
  const CLI::Option* opening =
      metres("--opening", request.opening, "one row, at this distance between the jaw edges [m]")
          ->excludes("--from")
          ->excludes("--to")
          ->excludes("--steps")
          ->excludes("--summary");
  if (const auto code = line.parse(argc, argv)) return *code;
  if (steps->count() + summary->count() + opening->count() == 0) {
    std::cerr << "grapple_table: --steps, --summary or --opening is required (--help shows the options)\n";
    return kExitWrongUsage;
  }

  const Checked<Grapple> grapple = loadGrapple(files);
  if (!grapple.value) return fail(grapple.problems);
  const std::optional<std::string> problem = printTable(*grapple.value, request, std::cout);
  if (problem) return fail({*problem});
  return finishOutput();
}

}  // namespace
}  // namespace hammer_loads

int main(int argc, char** argv) { return hammer_loads::run(argc, argv); }
