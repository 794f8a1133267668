# Module hammer_loads_py, a package of Python: compiled part, __init__.py, type stubs. From pybind11 2.6 on.
set(development Development.Module)
if(CMAKE_VERSION VERSION_LESS 3.18)
  set(development Development)
endif()
if(PYTHON_EXECUTABLE AND NOT Python3_EXECUTABLE)
  set(Python3_EXECUTABLE ${PYTHON_EXECUTABLE})  # catkin's
endif()
find_package(Python3 QUIET COMPONENTS Interpreter ${development})
set(Python_FOUND FALSE)  # another package's interpreter without headers, as catkin's of Debian 13; pybind11 would take it
find_package(pybind11 2.6 QUIET)
if(NOT Python3_FOUND OR NOT pybind11_FOUND)
  message(WARNING "Python: hammer_loads_py is not built: found ${Python3_EXECUTABLE}, but not both its headers (Debian: "
                  "python3-dev) and pybind11 2.6 or later (pybind11-dev)")
else()
  #catkin_lint: skip
  if(HAMMER_LOADS_ROS)
    set(python_package ${CATKIN_DEVEL_PREFIX}/${CATKIN_GLOBAL_PYTHON_DESTINATION}/hammer_loads_py)
  else()
    set(python_package ${CMAKE_BINARY_DIR}/${CATKIN_GLOBAL_PYTHON_DESTINATION}/hammer_loads_py)
  endif()
  message(STATUS "Python: hammer_loads_py is built for ${Python3_EXECUTABLE}")
  pybind11_add_module(hammer_loads_py MODULE NO_EXTRAS src/hammer_loads/python/module.cpp)
  target_link_libraries(hammer_loads_py PRIVATE hammer_loads_settings)
  set_target_properties(hammer_loads_py PROPERTIES OUTPUT_NAME _native LIBRARY_OUTPUT_DIRECTORY ${python_package}
                        INSTALL_RPATH "\$ORIGIN/../../.." CXX_VISIBILITY_PRESET hidden)
  foreach(file __init__.py __init__.pyi py.typed)
    configure_file(src/hammer_loads/python/package/${file} ${python_package}/${file} COPYONLY)
  endforeach()
  install(TARGETS hammer_loads_py LIBRARY DESTINATION ${CATKIN_GLOBAL_PYTHON_DESTINATION}/hammer_loads_py)
  install(DIRECTORY src/hammer_loads/python/package/ DESTINATION ${CATKIN_GLOBAL_PYTHON_DESTINATION}/hammer_loads_py
          PATTERN __pycache__ EXCLUDE)
endif()
