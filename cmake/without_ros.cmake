# HAMMER_LOADS_ROS=OFF: what catkin gives otherwise. Nothing here looks for a package of ROS.
option(BUILD_SHARED_LIBS "shared libraries" ON)
include(CTest)

set(CMAKE_LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/lib)
set(CMAKE_ARCHIVE_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/lib)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)

# lib, also where the distribution has lib/ARCHITECTURE: parameters are found beside it.
set(CATKIN_PACKAGE_BIN_DESTINATION bin)
set(CATKIN_PACKAGE_LIB_DESTINATION lib)
set(CATKIN_PACKAGE_INCLUDE_DESTINATION include/hammer_loads)
set(CATKIN_GLOBAL_INCLUDE_DESTINATION include)
set(CATKIN_PACKAGE_SHARE_DESTINATION share/hammer_loads)
set(CATKIN_GLOBAL_BIN_DESTINATION bin)
set(CATKIN_GLOBAL_PYTHON_DESTINATION lib/python3/dist-packages)
set(CATKIN_ENABLE_TESTING ${BUILD_TESTING})

# hammer_loads_install_package(LIBRARIES...): find_package(hammer_loads) with targets hammer_loads::core ..., and
# pkg-config hammer_loads
function(hammer_loads_install_package)
  include(CMakePackageConfigHelpers)
  foreach(library ${ARGN})
    string(REPLACE hammer_loads_ "" name ${library})
    set_target_properties(${library} PROPERTIES EXPORT_NAME ${name})
    add_library(hammer_loads::${name} ALIAS ${library})
    list(INSERT link_flags 0 -l${library})  # who needs others comes before them
  endforeach()
  string(REPLACE ";" " " link_flags "${link_flags}")
  install(EXPORT hammer_loads_targets NAMESPACE hammer_loads:: DESTINATION lib/cmake/hammer_loads)
  configure_package_config_file(cmake/hammer_loads-config.cmake.in ${CMAKE_BINARY_DIR}/hammer_loads-config.cmake
                                INSTALL_DESTINATION lib/cmake/hammer_loads)
  write_basic_package_version_file(${CMAKE_BINARY_DIR}/hammer_loads-config-version.cmake COMPATIBILITY SameMinorVersion)
  configure_file(cmake/hammer_loads.pc.in ${CMAKE_BINARY_DIR}/hammer_loads.pc @ONLY)
  install(FILES ${CMAKE_BINARY_DIR}/hammer_loads-config.cmake ${CMAKE_BINARY_DIR}/hammer_loads-config-version.cmake
          DESTINATION lib/cmake/hammer_loads)
  install(FILES ${CMAKE_BINARY_DIR}/hammer_loads.pc DESTINATION lib/pkgconfig)
endfunction()
