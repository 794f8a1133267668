# Headers that most files of a target include, compiled once. Only what is no part of this package: a change here never
# rebuilds everything. The scripts build so; ccache needs CCACHE_SLOPPINESS=pch_defines,time_macros with it.
option(HAMMER_LOADS_PRECOMPILE "compile common headers once: a clean build takes a quarter less time" OFF)

set(hammer_loads_std_headers <algorithm> <array> <cmath> <cstdint> <functional> <limits> <memory> <optional> <string>
                             <utility> <vector>)

# hammer_loads_precompile(TARGET HEADERS...): TARGET's own
function(hammer_loads_precompile target)
  if(HAMMER_LOADS_PRECOMPILE)
    set_target_properties(${target} PROPERTIES DEFINE_SYMBOL "")  # GCC refuses headers compiled with another macro
    target_precompile_headers(${target} PRIVATE ${hammer_loads_std_headers} ${ARGN})
  endif()
endfunction()

# hammer_loads_precompile_as(OWNER TARGETS...): the same headers, with the same compiler options
function(hammer_loads_precompile_as owner)
  if(HAMMER_LOADS_PRECOMPILE)
    foreach(target ${ARGN})
      set_target_properties(${target} PROPERTIES DEFINE_SYMBOL "")
      target_precompile_headers(${target} REUSE_FROM ${owner})
    endforeach()
  endif()
endfunction()
