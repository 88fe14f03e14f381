# SPDX-License-Identifier: Apache-2.0
# cmake -DFOLDER=dist -DTABLE=x.cpp -P page_table.cmake: all files of FOLDER as a source file that defines page_table()
# of telemime/live/live_files.h. The assembler takes the bytes in as they are: compilers are slow with long arrays.
cmake_minimum_required(VERSION 3.22)
file(GLOB_RECURSE files RELATIVE "${FOLDER}" "${FOLDER}/*")
list(SORT files)
if(NOT EXISTS "${FOLDER}/index.html")
  message(FATAL_ERROR "there is no index.html in ${FOLDER}")
endif()

set(bytes "")
set(rows "")
set(number 0)
foreach(file IN LISTS files)
  string(REGEX MATCH "[^A-Za-z0-9_./-]" strange "${file}")
  if(strange)
    message(FATAL_ERROR "the page has a file with '${strange}' in its name, which needs quoting: ${file}")
  endif()
  file(SIZE "${FOLDER}/${file}" size)
  # The hash tells compiler caches that a file has changed.
  file(SHA256 "${FOLDER}/${file}" hash)
  set(name "telemime_page_${number}")
  string(APPEND bytes
         "extern \"C\" __attribute__((visibility(\"hidden\"))) const char ${name}[];\n"
         "__asm__(\"/* ${hash} */\\n.pushsection .rodata\\n.balign 16\\n.globl ${name}\\n.hidden ${name}\\n${name}:\\n\"\n"
         "        \".incbin \\\"${FOLDER}/${file}\\\"\\n.byte 0\\n.popsection\\n\");\n")
  string(APPEND rows "    {\"/${file}\", {${name}, ${size}}},\n")
  math(EXPR number "${number} + 1")
endforeach()
file(WRITE "${TABLE}"
     "// Made by cmake/page_table.cmake.\n#include \"telemime/live/live_files.h\"\n\n${bytes}\n"
     "namespace telemime {\n\nstd::span<const PageFile> page_table() {\n  static const PageFile table[] = {\n${rows}  };\n"
     "  return table;\n}\n\n}  // namespace telemime\n")
