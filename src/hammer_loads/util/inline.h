/// Formulas of the hot path are small, but together exceed what a compiler inlines of its own accord at -O2; as calls
/// they would pass some thirty doubles through memory.
#pragma once

#if defined(__GNUC__)
#define HAMMER_LOADS_INLINE [[gnu::always_inline]] inline
#else
#define HAMMER_LOADS_INLINE inline
#endif
