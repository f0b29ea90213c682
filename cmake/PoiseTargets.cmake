# poise_library(NAME SOURCES ... [DEPS ...] [PRIVATE_DEPS ...])
#   One static library per core folder. Headers are found from the project root, as
#   "core/motion/clip.h".
function(poise_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPS;PRIVATE_DEPS" ${ARGN})
  if(ARG_SOURCES)
    add_library(${name} STATIC ${ARG_SOURCES})
    target_compile_options(${name} PRIVATE ${POISE_WARNINGS})
    target_include_directories(${name} PUBLIC "${PROJECT_SOURCE_DIR}")
    target_link_libraries(${name} PUBLIC ${ARG_DEPS} PRIVATE ${ARG_PRIVATE_DEPS})
  else()
    add_library(${name} INTERFACE)
    target_include_directories(${name} INTERFACE "${PROJECT_SOURCE_DIR}")
    target_link_libraries(${name} INTERFACE ${ARG_DEPS})
  endif()
endfunction()

# poise_kernel(TARGET SOURCE)
#   Compiles one hot source three times, for x86-64-v2, -v3 and -v4, into TARGET. In the source
#   POISE_KERNEL_ISA names the namespace of this build (isa_v2, isa_v3, isa_v4) and core/base/isa.h
#   chooses among them at run time. Eigen is renamed per build: otherwise the linker could keep the
#   v4 copy of an inline function for code that must run on an older CPU.
function(poise_kernel target source)
  get_filename_component(stem "${source}" NAME_WE)
  foreach(isa v2 v3 v4)
    set(object ${target}_${stem}_${isa})
    add_library(${object} OBJECT "${source}")
    target_compile_options(${object} PRIVATE ${POISE_WARNINGS} -O3 -march=x86-64-${isa}
                           -ffp-contract=fast -fno-math-errno ${POISE_KERNEL_WARNINGS})
    target_compile_definitions(${object} PRIVATE POISE_KERNEL_ISA=isa_${isa} Eigen=Eigen_${isa})
    target_include_directories(${object} PRIVATE "${PROJECT_SOURCE_DIR}")
    target_link_libraries(${object} PRIVATE Eigen3::Eigen)
    target_sources(${target} PRIVATE $<TARGET_OBJECTS:${object}>)
  endforeach()
endfunction()

# poise_program(NAME SOURCES ... [DEPS ...] [TORCH])
#   TORCH links the start-up code that gives LibTorch's BLAS its environment before it loads.
function(poise_program name)
  cmake_parse_arguments(ARG "TORCH" "" "SOURCES;DEPS" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_compile_options(${name} PRIVATE ${POISE_WARNINGS})
  target_include_directories(${name} PRIVATE "${PROJECT_SOURCE_DIR}")
  target_link_libraries(${name} PRIVATE ${ARG_DEPS})
  if(ARG_TORCH)
    target_sources(${name} PRIVATE $<TARGET_OBJECTS:poise_launch_environment>)
  endif()
endfunction()

# poise_test(NAME SOURCES ... [DEPS ...] [LABELS unit|integration|slow|lint] [TORCH] [SERIAL]
#            [THREADS] [TIMEOUT s])
#   One GoogleTest program; its cases become ctest cases. SERIAL: no other test runs beside them.
#   THREADS: what it tests is shared by threads, and what it links sees enough of them that
#   ThreadSanitizer can judge it. Only these programs are cases of the preset tsan.
function(poise_test name)
  cmake_parse_arguments(ARG "TORCH;SERIAL;THREADS" "TIMEOUT" "SOURCES;DEPS;LABELS" ${ARGN})
  if(NOT ARG_LABELS)
    set(ARG_LABELS unit)
  endif()
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 300)
  endif()
  set(torch_flag "")
  if(ARG_TORCH)
    set(torch_flag TORCH)
  endif()
  poise_program(${name} SOURCES ${ARG_SOURCES} DEPS ${ARG_DEPS} GTest::gmock_main ${torch_flag})
  if(ARG_THREADS)
    add_dependencies(poise_threaded_tests ${name})
  elseif(POISE_SANITIZER STREQUAL "thread")
    return()
  endif()
  gtest_discover_tests(${name} DISCOVERY_MODE PRE_TEST DISCOVERY_TIMEOUT 60
    PROPERTIES LABELS "${ARG_LABELS}" TIMEOUT ${ARG_TIMEOUT} RUN_SERIAL ${ARG_SERIAL}
               SKIP_REGULAR_EXPRESSION "\\[  SKIPPED \\]"
               ENVIRONMENT "${POISE_TEST_ENVIRONMENT}")
endfunction()

# poise_link_torch(TARGET)
#   Links LibTorch. Debian's is a system package, but its target does not say so.
function(poise_link_torch target)
  get_target_property(torch_includes torch INTERFACE_INCLUDE_DIRECTORIES)
  target_include_directories(${target} SYSTEM PRIVATE ${torch_includes})
  target_link_libraries(${target} PRIVATE torch)
  if(POISE_CCACHE)
    # What ccache needs to know of precompiled headers.
    set_target_properties(${target} PROPERTIES CXX_COMPILER_LAUNCHER
      "${CMAKE_COMMAND};-E;env;CCACHE_SLOPPINESS=pch_defines,time_macros;${POISE_CCACHE}")
    target_compile_options(${target} PRIVATE -fpch-preprocess)
  endif()
endfunction()

# poise_use_torch(TARGET SOURCE...)
#   Links LibTorch, and gives those sources, which include <torch/torch.h>, its precompiled header.
#   The other sources of the target stay without it: loading it costs them more than they need.
function(poise_use_torch target)
  poise_link_torch(${target})
  target_precompile_headers(${target} REUSE_FROM poise_torch_header)
  get_target_property(sources ${target} SOURCES)
  foreach(source ${sources})
    if(NOT source IN_LIST ARGN)
      set_source_files_properties("${source}" PROPERTIES SKIP_PRECOMPILE_HEADERS ON)
    endif()
  endforeach()
endfunction()
