# One place for language level, warnings, sanitizers and the flags that keep results reproducible.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)

find_program(PLUMBLINE_CCACHE ccache)
if(PLUMBLINE_CCACHE)
  set(CMAKE_CXX_COMPILER_LAUNCHER "${PLUMBLINE_CCACHE}")
endif()

# Interface target: every own target links it. No -ffast-math (it breaks Eigen 3.4 with GCC 12), no
# contraction to FMA (Debug and Release agree), 16-byte Eigen alignment (ABI of the system libraries).
# Users of the installed library get the language level and what changes the layout of types.
add_library(plumbline_flags INTERFACE)
target_compile_features(plumbline_flags INTERFACE cxx_std_20)
target_compile_options(plumbline_flags INTERFACE $<BUILD_INTERFACE:-ffp-contract=off>)
target_compile_definitions(plumbline_flags INTERFACE EIGEN_MAX_ALIGN_BYTES=16)
# Eigen cuts large products into blocks that suit the processor's caches, and sums in their order: blocks
# of one size give the same bytes on every processor.
target_compile_definitions(plumbline_flags INTERFACE EIGEN_NO_CPUID)
# GCC collects its garbage less often: a tenth less time, up to 0.4 GB more memory a file.
target_compile_options(plumbline_flags INTERFACE
                       $<BUILD_INTERFACE:$<$<CXX_COMPILER_ID:GNU>:--param=ggc-min-heapsize=1048576>>)
if(PLUMBLINE_MARCH)
  target_compile_options(plumbline_flags INTERFACE $<BUILD_INTERFACE:-march=${PLUMBLINE_MARCH}>)
endif()
if(PLUMBLINE_SANITIZE)
  # Checks of each access for null and for the object's size take half of the time of compiling, and find nothing
  # that AddressSanitizer would miss; the check of dynamic types is for casts between classes, of which there are none.
  target_compile_options(plumbline_flags INTERFACE -fsanitize=${PLUMBLINE_SANITIZE}
                         -fno-sanitize=null,object-size,vptr
                         -fno-omit-frame-pointer -fno-sanitize-recover=all)
  target_link_options(plumbline_flags INTERFACE -fsanitize=${PLUMBLINE_SANITIZE})
endif()

add_library(plumbline_warnings INTERFACE)
target_compile_options(plumbline_warnings INTERFACE
                       -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Woverloaded-virtual
                       # GCC 12 reports overlapping, endless and misplaced copies inside std::string (GCC bug
                       # 105651), the more the less it remembers which header they come from.
                       $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict;-Wno-array-bounds;-Wno-stringop-overflow>)
if(PLUMBLINE_WERROR)
  target_compile_options(plumbline_warnings INTERFACE -Werror)
endif()
