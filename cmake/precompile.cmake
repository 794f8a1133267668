# Headers that most files of a target include, compiled once. Only what is no part of this package: a change here never
# rebuilds everything. The scripts build so; ccache needs CCACHE_SLOPPINESS=pch_defines,time_macros with it.
option(HAMMER_LOADS_PRECOMPILE "compile common headers once: a clean build takes a quarter less time" OFF)

# GCC collects garbage from 128 MB on: a tenth of the time of a file with many templates, for a fifth of its memory.
if(HAMMER_LOADS_PRECOMPILE AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  add_compile_options("SHELL:--param ggc-min-heapsize=2000000")
endif()

set(hammer_loads_std_headers <algorithm> <array> <cmath> <cstdint> <functional> <limits> <memory> <optional> <string>
                             <utility> <vector>)

# hammer_loads_precompile(TARGET HEADERS...): TARGET's own
function(hammer_loads_precompile target)
  if(HAMMER_LOADS_PRECOMPILE)
    set_target_properties(${target} PROPERTIES DEFINE_SYMBOL "")  # GCC refuses headers compiled with another macro
    target_precompile_headers(${target} PRIVATE ${hammer_loads_std_headers} ${ARGN})
  endif()
endfunction()

# hammer_loads_precompile_as(OWNER TARGETS...): the same headers. Another -O above 0 does no harm; a library's need -fPIC
# in a program as well.
function(hammer_loads_precompile_as owner)
  if(HAMMER_LOADS_PRECOMPILE)
    foreach(target ${ARGN})
      set_target_properties(${target} PROPERTIES DEFINE_SYMBOL "")
      get_target_property(type ${owner} TYPE)
      if(NOT type STREQUAL "EXECUTABLE")
        target_compile_options(${target} PRIVATE -fPIC)
      endif()
      target_precompile_headers(${target} REUSE_FROM ${owner})
    endforeach()
  endif()
endfunction()
