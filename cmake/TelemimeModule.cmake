# SPDX-License-Identifier: Apache-2.0
# One module: a static library from every *.cpp below the module's folder (but a main.cpp), and one test program from
# every *_test.cpp.
# It may include the modules in DEPENDS, and theirs (checked by tests/layering).

include("${CMAKE_CURRENT_LIST_DIR}/TelemimeDiscover.cmake")

add_library(telemime_flags INTERFACE)
target_compile_features(telemime_flags INTERFACE cxx_std_20)
target_compile_options(telemime_flags INTERFACE -Wall -Wextra -Wpedantic
                       $<$<NOT:$<BOOL:$<TARGET_PROPERTY:UNITY_BUILD>>>:-Wshadow> -Wnon-virtual-dtor)
if(TELEMIME_WERROR)
  target_compile_options(telemime_flags INTERFACE -Werror)
endif()
# GCC 12 takes "text" + std::to_string(...) for an overlapping copy (its bug 105651).
target_compile_options(telemime_flags INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)
# Test programs do little work themselves: optimising them less saves a fifth of their compile time.
add_library(telemime_test_flags INTERFACE)
target_link_libraries(telemime_test_flags INTERFACE telemime_flags)
if(NOT TELEMIME_SANITIZE)
  target_compile_options(telemime_test_flags INTERFACE -O1)
endif()
# So is what waits for others more than it computes: what is made of Boost.Beast compiles in two thirds of the time.
add_library(telemime_waiting_flags INTERFACE)
target_link_libraries(telemime_waiting_flags INTERFACE telemime_flags)
if(NOT TELEMIME_SANITIZE)
  target_compile_options(telemime_waiting_flags INTERFACE $<$<CONFIG:Release>:-O1>)
endif()
# -ffp-contract=off keeps results the same with and without fused multiply-add.
target_compile_options(telemime_flags INTERFACE -ffp-contract=off)
if(TELEMIME_SANITIZE)
  target_compile_options(telemime_flags INTERFACE -fsanitize=${TELEMIME_SANITIZE} -fno-omit-frame-pointer
                                                  -fno-sanitize-recover=all)
  target_link_options(telemime_flags INTERFACE -fsanitize=${TELEMIME_SANITIZE})
  if(TELEMIME_SANITIZE MATCHES "undefined")
    # Left out because they double the time to compile code that uses Eigen; the address sanitizer meets null
    # pointers and overruns anyway.
    target_compile_options(telemime_flags INTERFACE -fno-sanitize=null,alignment,object-size,vptr)
  endif()
  if(TELEMIME_SANITIZE MATCHES "thread")
    # Asio's fences only back up its locks, which the sanitizer does see; GCC warns that it does not see fences.
    target_compile_options(telemime_flags INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-tsan>)
  endif()
  # GCC's manual: sanitizers make this warning fire without cause (here in std::regex).
  target_compile_options(telemime_flags INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
endif()

# Precompiled headers are for builds that are made whole; without them the compiler sees missing includes.
if(TELEMIME_PCH)
  # GCC 12 finds more faults of that kind in std::string where there are none when headers are precompiled.
  target_compile_options(telemime_flags INTERFACE
                         $<$<CXX_COMPILER_ID:GNU>:-Wno-stringop-overflow$<SEMICOLON>-Wno-array-bounds>)
  set(pch_headers <algorithm> <array> <functional> <memory> <optional> <span> <string> <vector> <Eigen/Dense>
                  <nlohmann/json.hpp> <opencv2/core.hpp>)
  file(CONFIGURE OUTPUT "${PROJECT_BINARY_DIR}/pch.cpp" CONTENT "int main() {}\n")  # not touched where it is the same
  # A library for the modules, a program for the tests: their code is made for different positions in memory.
  add_library(telemime_pch_flags STATIC "${PROJECT_BINARY_DIR}/pch.cpp")
  add_library(telemime_pch_waiting_flags STATIC "${PROJECT_BINARY_DIR}/pch.cpp")
  set(kinds flags waiting_flags)
  if(TELEMIME_TESTS)
    add_executable(telemime_pch_test_flags "${PROJECT_BINARY_DIR}/pch.cpp")
    target_link_libraries(telemime_pch_test_flags PRIVATE GTest::gtest)
    target_precompile_headers(telemime_pch_test_flags PRIVATE ${pch_headers} <gtest/gtest.h>)
    list(APPEND kinds test_flags)
  endif()
  foreach(kind IN LISTS kinds)
    target_link_libraries(telemime_pch_${kind} PRIVATE telemime_${kind} Eigen3::Eigen nlohmann_json::nlohmann_json
                                                       ${OpenCV_LIBS})
    target_include_directories(telemime_pch_${kind} SYSTEM PRIVATE ${OpenCV_INCLUDE_DIRS})
  endforeach()
  target_precompile_headers(telemime_pch_flags PRIVATE ${pch_headers})
  # Code is optimised as much as the headers were that it begins with.
  target_precompile_headers(telemime_pch_waiting_flags PRIVATE ${pch_headers} <boost/asio/io_context.hpp>
                            <boost/asio/ip/tcp.hpp> <boost/asio/ssl/stream.hpp> <boost/asio/steady_timer.hpp>
                            <boost/beast/core.hpp> <boost/beast/http.hpp> <boost/beast/websocket.hpp>)
  target_link_libraries(telemime_pch_waiting_flags PRIVATE Boost::headers)
endif()
function(telemime_pch target kind)
  if(TELEMIME_PCH)
    target_precompile_headers(${target} REUSE_FROM telemime_pch_${kind})
  endif()
endfunction()

# Test programs that read files of the project know where it is. The others are compiled alike wherever it is.
function(telemime_source_dir target)
  foreach(source IN LISTS ARGN)
    get_filename_component(path "${source}" ABSOLUTE)
    file(STRINGS "${path}" uses REGEX "TELEMIME_SOURCE_DIR|\"support/needs\\.h\"" LIMIT_COUNT 1)
    if(uses)
      target_compile_definitions(${target} PRIVATE TELEMIME_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
      return()
    endif()
  endforeach()
endfunction()

# The last line of a program of which a test was skipped and none failed: ctest would hide a failure behind a line that
# any skipped test prints.
set(TELEMIME_SKIPPED "\\[  SKIPPED \\] [A-Za-z0-9_./]+[^A-Za-z0-9]*$")

# WAITS: it waits for others more than it computes. PRIVATE: not installed. INCLUDE: the folder that its #include lines
# start from (src of the project).
function(telemime_module name)
  cmake_parse_arguments(MODULE "WAITS;PRIVATE" "INCLUDE" "DEPENDS;LIBRARIES" ${ARGN})
  if(NOT MODULE_INCLUDE)
    set(MODULE_INCLUDE "${PROJECT_SOURCE_DIR}/src")
  endif()
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/*.cpp")
  set(tests ${sources})
  list(FILTER sources EXCLUDE REGEX "(_test|/main)\\.cpp$")
  list(FILTER tests INCLUDE REGEX "_test\\.cpp$")

  add_library(telemime_${name} STATIC ${sources})
  add_library(telemime::${name} ALIAS telemime_${name})
  set_target_properties(telemime_${name} PROPERTIES EXPORT_NAME ${name})
  # Public: a user's compiler must take the headers as C++20, too.
  target_compile_features(telemime_${name} PUBLIC cxx_std_20)
  target_include_directories(telemime_${name} PUBLIC $<BUILD_INTERFACE:${MODULE_INCLUDE}>
                                                     $<INSTALL_INTERFACE:include>)
  target_include_directories(telemime_${name} SYSTEM PUBLIC $<BUILD_INTERFACE:${OpenCV_INCLUDE_DIRS}>)
  foreach(module IN LISTS MODULE_DEPENDS)
    target_link_libraries(telemime_${name} PUBLIC telemime_${module})
  endforeach()
  set(flags flags)
  if(MODULE_WAITS)
    set(flags waiting_flags)
  endif()
  target_link_libraries(telemime_${name} PUBLIC ${MODULE_LIBRARIES} PRIVATE $<BUILD_INTERFACE:telemime_${flags}>)
  telemime_pch(telemime_${name} ${flags})
  telemime_unity(telemime_${name} ${sources})
  if(NOT MODULE_PRIVATE)
    set_property(GLOBAL APPEND PROPERTY TELEMIME_MODULES telemime_${name})
  endif()

  if(TELEMIME_TESTS AND tests)
    add_executable(${name}_test ${tests})
    telemime_unity(${name}_test ${tests})
    target_link_libraries(${name}_test PRIVATE telemime_${name} telemime_test_flags GTest::gtest GTest::gtest_main)
    telemime_pch(${name}_test test_flags)
    telemime_source_dir(${name}_test ${tests})
    telemime_discover(${name}_test ${name} PROPERTIES TIMEOUT 300 SKIP_REGULAR_EXPRESSION "${TELEMIME_SKIPPED}")
  endif()
endfunction()

# A test program of more than one module, below tests/: telemime_test(laws SOURCES a_test.cpp MODULES likelihood search
# LABELS slow). The label "slow" keeps it out of the runs under sanitizers. EACH: as for telemime_discover.
function(telemime_test name)
  cmake_parse_arguments(TEST "EACH" "" "SOURCES;MODULES;LIBRARIES;LABELS" ${ARGN})
  set(labels)
  if(TEST_LABELS)
    set(labels LABELS "${TEST_LABELS}")
  endif()
  set(each)
  if(TEST_EACH)
    set(each EACH)
  endif()
  add_executable(${name}_test ${TEST_SOURCES})
  telemime_unity(${name}_test ${TEST_SOURCES})
  if(TELEMIME_SANITIZE AND "slow" IN_LIST TEST_LABELS)
    set_target_properties(${name}_test PROPERTIES EXCLUDE_FROM_ALL ON)  # it would not run: see CMakePresets.json
  endif()
  list(TRANSFORM TEST_MODULES PREPEND telemime::)
  target_link_libraries(${name}_test PRIVATE ${TEST_MODULES} ${TEST_LIBRARIES} telemime_test_flags GTest::gtest
                                             GTest::gtest_main)
  telemime_pch(${name}_test test_flags)
  telemime_source_dir(${name}_test ${TEST_SOURCES})
  telemime_discover(${name}_test ${name} ${each} PROPERTIES TIMEOUT 300
                                                          SKIP_REGULAR_EXPRESSION "${TELEMIME_SKIPPED}" ${labels})
endfunction()
