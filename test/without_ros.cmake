# Tests of what is built without ROS; `cmake --build . --target tests`, then ctest.
find_package(GTest REQUIRED)
find_package(Python3 QUIET COMPONENTS Interpreter)
set(test_dir ${PROJECT_SOURCE_DIR}/test)
add_custom_target(tests)
add_library(hammer_loads_test_main OBJECT EXCLUDE_FROM_ALL ${test_dir}/support/main.cpp
            ${test_dir}/support/counting_new.cpp)
target_include_directories(hammer_loads_test_main PRIVATE ${test_dir})

# hammer_loads_room(FOLDER LIBRARIES...): tests of one room, less those that need ROS
function(hammer_loads_room room)
  file(GLOB sources CONFIGURE_DEPENDS ${test_dir}/${room}/*_test.cpp)
  list(FILTER sources EXCLUDE REGEX "/(ros_parameters|urdf|urdf_tree)_test.cpp$")
  if(room STREQUAL "commands")
    list(FILTER sources INCLUDE REGEX "/(count_cycles|evaluate|turn_table|life)_test.cpp$")
  endif()
  add_executable(${room}_test EXCLUDE_FROM_ALL ${sources} $<TARGET_OBJECTS:hammer_loads_test_main>)
  target_include_directories(${room}_test PRIVATE ${test_dir})
  target_compile_definitions(${room}_test PRIVATE HAMMER_LOADS_TEST_DATA="${test_dir}/data")
  target_compile_options(${room}_test PRIVATE -O1)
  target_link_libraries(${room}_test ${ARGN} GTest::gtest Threads::Threads)
  add_dependencies(tests ${room}_test)
  add_test(NAME ${room} COMMAND ${room}_test)
endfunction()

include(${test_dir}/rooms.cmake)
hammer_loads_room(settings hammer_loads_command_line)
hammer_loads_room(commands hammer_loads_command_line)
foreach(command count_cycles evaluate life turn_table)
  string(TOUPPER ${command} name)
  target_compile_definitions(commands_test PRIVATE HAMMER_LOADS_${name}="$<TARGET_FILE:${command}>")
  add_dependencies(commands_test ${command})
endforeach()
hammer_loads_precompile_as(linkage_test settings_test commands_test)

if(TARGET hammer_loads_py)
  add_test(NAME python COMMAND ${CMAKE_COMMAND} -E env PYTHONDONTWRITEBYTECODE=1
           HAMMER_LOADS_MODULES=${CMAKE_BINARY_DIR}/${CATKIN_GLOBAL_PYTHON_DESTINATION} ${Python3_EXECUTABLE} -m pytest -q
           -p no:cacheprovider -o python_files=*_test.py ${test_dir}/python)
endif()
