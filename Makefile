# SPDX-License-Identifier: Apache-2.0
# Short names for what is done often; `make help` lists them. CMakePresets.json says how things are built.
SHELL := /bin/bash
.DEFAULT_GOAL := help
JOBS ?= $(shell nproc)
# Tests wait for clocks and for each other as long as they compute.
TEST_JOBS ?= $(shell echo $$(($(JOBS) + 1)))
PREFIX ?= /usr/local
FUZZ_SECONDS ?= 20
ASAN_QUICK = core capture nets outputs streaming meeting_protocol meeting_transport meeting_hosting live_stream
empty :=
TARGETS := help deps build demo test bench experiments accuracy peer lint asan asan-quick tsan fuzz install uninstall package package-test reference count clean
# Targets that install packages come before those that need them; JOBS and TEST_JOBS are what runs in parallel.
.NOTPARALLEL:
.PHONY: $(TARGETS) deps-page deps-python deps-test program configure

help: ## this list
	@sed -n 's/^\([a-z-]*\):[^#]*## \(.*\)/  make \1\t\2/p' Makefile | expand -t 20

deps: ## install the Debian packages that the program needs and that are missing (scripts/packages.txt)
	@scripts/deps.sh build

deps-page:
	@scripts/deps.sh build page

deps-python:
	@scripts/deps.sh python

deps-test:
	@scripts/deps.sh build page python test

# What has been configured with tests stays so: configured without them, it would have to be compiled again for them.
program:
	@{ cmake build/release || cmake --preset program; } > build-configure.log 2>&1 || \
	  { cat build-configure.log; exit 1; }
	@rm -f build-configure.log
	@cmake --build build/release --target telemime -j $(JOBS)

configure:
	@cmake --preset release > build-configure.log 2>&1 || { cat build-configure.log; exit 1; }
	@rm -f build-configure.log

build: deps-page program ## the program with its live page: build/release/telemime

demo: deps program ## track the clip in data/demo and score the result: out/demo
	@scripts/demo.sh

test: deps-test configure ## build and run the tests (the long ones: ctest --preset release -C long -L long)
	@cmake --build --preset release -j $(JOBS)
	@ctest --preset release -j $(TEST_JOBS)
	@/usr/bin/python3 scripts/skipped.py build/release/Testing/Temporary/LastTest.log

bench: deps-test configure ## run the benchmarks
	@cmake --build --preset release --target telemime-lab -j $(JOBS)
	@build/release/telemime-lab bench

experiments: deps-test configure ## measure the thesis's tables and figures again: out/experiments/report.html
	@scripts/deps.sh plots
	@cmake --build --preset release --target telemime-lab -j $(JOBS)
	@build/release/telemime-lab experiments all
	@/usr/bin/python3 apps/lab/plots.py out/experiments

accuracy: deps-test configure ## make and track the clips of the tables in docs/accuracy.md: out/accuracy
	@cmake --build --preset release --target telemime telemime-lab -j $(JOBS)
	@apps/lab/accuracy.sh

peer: deps-test configure ## compare with MediaPipe Pose on these clips and on others (FOLDERS="DIR DIR"): out/peer
	@cmake --build --preset release --target telemime telemime-lab -j $(JOBS)
	@apps/lab/peer.sh

lint: ## clang-format and clang-tidy; FILES="a.cpp b.h" for some only
	@scripts/deps.sh build python test check
	@scripts/lint.sh $(FILES)

asan: deps-test ## all but the slow tests and the laws under the address and undefined-behaviour sanitizers
	@cmake --preset asan
	@cmake --build --preset asan -j $(JOBS)
	@ctest --preset asan -j $(TEST_JOBS)

asan-quick: deps-test ## of these the tests of what reads bytes from elsewhere
	@scripts/deps.sh check
	@cmake --preset asan-quick
	@cmake --build --preset asan-quick --target $(ASAN_QUICK:=_test) -j $(JOBS)
	@ctest --preset asan-quick -j $(TEST_JOBS) -R '^($(subst $(empty) $(empty),|,$(ASAN_QUICK)))\.'

tsan: deps-test ## all but the slow tests under the thread sanitizer
	@cmake --preset tsan
	@setarch -R cmake --build --preset tsan -j $(JOBS)
	@setarch -R ctest --preset tsan -j $(TEST_JOBS)

fuzz: deps-test ## every fuzz target for FUZZ_SECONDS (20)
	@scripts/deps.sh check
	@cmake --preset fuzz
	@cmake --build --preset fuzz --target fuzz/all -j $(JOBS)
	@scripts/fuzz.sh $(FUZZ_SECONDS)

install: deps-python build ## install program, Python package, libraries, headers and data below PREFIX (/usr/local)
	@cmake --build build/release -j $(JOBS)
	@cmake --install build/release --prefix "$(PREFIX)"
	@cp build/release/install_manifest.txt build/release/installed_by_make.txt

uninstall: ## remove what `make install` installed last
	@scripts/uninstall.sh

package: deps-python build ## Debian packages, and a tarball with all libraries: build/release/packages
	@scripts/deps.sh package
	@cmake --build build/release --target telemime_reference telemime_copyright _telemime -j $(JOBS)
	@rm -rf build/release/packages
	@cd build/release && cpack > package.log 2>&1 || { cat package.log; exit 1; }
	@scripts/tarball.sh
	@ls -1 build/release/packages/*.deb

package-test: ## install the packages on clean systems without a network, and use them there (as root)
	@scripts/deps.sh package
	@scripts/package_test.sh

reference: ## the reference of the C++ library by Doxygen: out/reference/html/index.html
	@scripts/deps.sh check
	@mkdir -p out && rm -rf out/reference && doxygen docs/reference/Doxyfile
	@echo out/reference/html/index.html

count: ## lines of code, with and without tests, and their budgets
	@scripts/count.sh

clean: ## remove build/ and out/
	@rm -rf build out
