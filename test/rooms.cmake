# Rooms whose tests are the same with and without ROS; hammer_loads_room() is defined by who includes this.
hammer_loads_room(estimation hammer_loads_core)
hammer_loads_room(linkage hammer_loads_core)
hammer_loads_room(hammer hammer_loads_bench)
hammer_loads_room(crank hammer_loads_bench)
hammer_loads_room(property hammer_loads_core)
hammer_loads_room(grapple hammer_loads_grapple)
hammer_loads_room(boom hammer_loads_settings ${kdl_parser_LIBRARIES})
hammer_loads_room(life hammer_loads_ledger)
hammer_loads_room(pipeline hammer_loads_bench)
hammer_loads_room(simulation hammer_loads_bench)
hammer_loads_room(calibration hammer_loads_calibration hammer_loads_bench)
hammer_loads_room(bench hammer_loads_bench)
hammer_loads_room(tables hammer_loads_tables)
target_compile_definitions(bench_test PRIVATE HAMMER_LOADS_ACCURACY="$<TARGET_FILE:accuracy>")
add_dependencies(bench_test accuracy)

# What measures time or takes millions of steps.
foreach(test property/random_machines property/garbage_machines grapple/speed grapple/branch_property hammer/batch
             pipeline/unknown_force)
  set(source ${CMAKE_CURRENT_LIST_DIR}/${test}_test.cpp)
  set_property(SOURCE ${source} APPEND PROPERTY COMPILE_OPTIONS -O3)
  set_property(SOURCE ${source} PROPERTY SKIP_PRECOMPILE_HEADERS ON)  # with those of another optimisation GCC 10 fails
endforeach()

# Compiled once for all of them.
hammer_loads_precompile(linkage_test <gtest/gtest.h> <Eigen/Core> <Eigen/Geometry> <Eigen/LU> <fstream> <map> <sstream>
                        <yaml-cpp/yaml.h>)
hammer_loads_precompile_as(linkage_test estimation_test hammer_test crank_test property_test grapple_test boom_test
                           life_test pipeline_test simulation_test calibration_test bench_test tables_test)
