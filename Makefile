# A thin front of CMake: installs what Debian lacks, configures, builds, runs. `make help` lists the targets.
BUILD      ?= build
PREFIX     ?= /usr/local
JOBS       ?= $(shell nproc 2>/dev/null || echo 2)
TEST_JOBS  ?= 2
CASE       ?= cases/granular-collapse
KILLS      ?= 50
FUZZ_SECONDS ?= 60
TIDY_SECONDS ?= 60
RUN        ?= runs/$(notdir $(CASE))
TALUS      := $(BUILD)/talus
SANITIZE   := $(BUILD)-sanitize
OPTIONS    := -DTALUS_PORTABLE=$(if $(PORTABLE),ON,OFF) $(CMAKE_ARGS)
SOURCES     = $(shell find src include tests bench docs -name '*.[ch]' 2>/dev/null)
MAKEFLAGS  += --no-print-directory

# Open MPI asks for this where the user is root, as in containers.
export OMPI_ALLOW_RUN_AS_ROOT := 1
export OMPI_ALLOW_RUN_AS_ROOT_CONFIRM := 1

.PHONY: build tests help deps configure run test check test-sanitize test-kill test-mutants fuzz bench verify install package release-check docs gallery format format-check tidy clean

build: configure ## Build the program, build/talus, its library and manual (the default). PORTABLE=1: for any machine
	@cmake --build $(BUILD) --parallel $(JOBS)

tests: configure ## Build the tests, too
	@cmake --build $(BUILD) --parallel $(JOBS) --target all tests

help: ## This list
	@awk -F ':.*## ' '/^[a-z-]+:.*## / {printf "  make %-14s %s\n", $$1, $$2}' $(MAKEFILE_LIST)

deps: ## Install the Debian packages that are missing, through apt
	@cmake/debian-packages.sh build

configure: deps
	@cmake -S . -B $(BUILD) -G Ninja --log-level=WARNING -DCMAKE_BUILD_TYPE=Release $(OPTIONS) >/dev/null

run: build ## Run a case and draw it: CASE=cases/granular-collapse, into RUN=runs/granular-collapse
	@$(TALUS) run $(CASE)/case.yaml --out $(RUN) --force
	@$(TALUS) plot $(RUN)
	@echo "pictures:"; find $(RUN) -name '*.png' | sort

test: tests ## Run all tests
	@cmake/run-tests.sh $(BUILD) $(TEST_JOBS) $(TEST_ARGS)

check: tests ## What a change must pass besides the tests: format-check, tidy CHANGED=1, test-sanitize FAST=1
	@cmake/run-checks.sh $(BUILD)

test-sanitize: deps ## The same tests under AddressSanitizer and UndefinedBehaviorSanitizer; FAST=1: those of a second or less
	@cmake -S . -B $(SANITIZE) -G Ninja --log-level=WARNING -DCMAKE_BUILD_TYPE=RelWithDebInfo -DTALUS_SANITIZE=ON \
	  $(OPTIONS) >/dev/null
	@cmake --build $(SANITIZE) --parallel $(JOBS) --target $(if $(FAST),fast_tests,talus tests)
	@cmake/run-tests.sh $(SANITIZE) $(TEST_JOBS) $(if $(FAST),-L fast) $(TEST_ARGS)

test-kill: tests ## Kill a run 50 times at random moments on one rank, 50 times on two; let every allocation fail once: KILLS=50
	@OPENBLAS_NUM_THREADS=1 sh tests/program/kill.sh $(abspath $(TALUS)) 1 $(KILLS)
	@OPENBLAS_NUM_THREADS=1 sh tests/program/kill.sh $(abspath $(TALUS)) 2 $(KILLS)
	@OPENBLAS_NUM_THREADS=1 TALUS_MEMORY_STRIDE=1 $(BUILD)/tests/bin/run_test_memory

test-mutants: deps ## Seed one fault after another in a copy, see which tests fail (hours): ROOM=solve MUTANT=name WORKERS=1, LIST=1, CONTINUE=1
	@ROOM="$(ROOM)" MUTANT="$(MUTANT)" WORKERS="$(or $(WORKERS),1)" bash tests/mutants/run.sh \
	  $(if $(LIST),--list) $(if $(CONTINUE),--continue) .

fuzz: ## Throw random bytes at the readers of cases, meshes and checkpoints: FUZZ_SECONDS=60 each
	@cmake/debian-packages.sh build fuzz
	@cmake -S . -B $(BUILD)-fuzz -G Ninja --log-level=WARNING -DCMAKE_BUILD_TYPE=RelWithDebInfo -DCMAKE_C_COMPILER=clang \
	  -DTALUS_FUZZ=ON $(OPTIONS) >/dev/null
	@cmake --build $(BUILD)-fuzz --parallel $(JOBS) --target fuzzers
	@sh tests/fuzz/run.sh $(BUILD)-fuzz $(FUZZ_SECONDS)

bench: build ## Build and run the performance benchmarks
	@cmake --build $(BUILD) --parallel $(JOBS) --target bench
	@if [ -f bench/run.sh ]; then OPENBLAS_NUM_THREADS=1 sh bench/run.sh $(BUILD); else echo "bench/run.sh is not there"; exit 1; fi

verify: build ## Verify every case that has reference values, and all of the tutorial; FULL=1: on the finest grids too
	@status=0; for reference in cases/*/reference.yaml; do \
	  [ -f "$$reference" ] || continue; \
	  $(TALUS) verify $(if $(FULL),--full) "$$(dirname "$$reference")" || status=$$?; \
	done; \
	for page in docs/tutorial/*.md; do python3 tests/docs/tutorial.py $(TALUS) $$page --long || status=$$?; done; exit $$status

install: build ## Install program, library, manual, completions and cases under PREFIX=/usr/local; `make docs` before: these, too
	@cmake --install $(BUILD) --prefix $(abspath $(PREFIX))

package: ## Build Debian packages for any x86-64 or arm64 machine, in build/package: MAINTAINER="Name <address>" (git's name for you)
	@cmake/debian-packages.sh build docs package
	@TALUS_MAINTAINER="$${TALUS_MAINTAINER:-$(MAINTAINER)}" sh packaging/build.sh $(BUILD)/package

release-check: ## Before a tag: do all files tell the same version, and is nothing left open? VERSION=0.2.0
	@sh packaging/release-check.sh $(VERSION)

docs: ## Build the site of the documentation, in build/docs/html
	@cmake/debian-packages.sh build docs
	@$(MAKE) configure
	@cmake --build $(BUILD) --parallel $(JOBS) --target talus
	@cmake --build $(BUILD) --target docs

LIMIT ?= 60
gallery: build ## Measure the gallery's seconds of all cases below a minute (half an hour): LIMIT=900 CASES="slope cook" of these
	@python3 docs/site/measure.py $(TALUS) $(LIMIT) $(CASES)

format: ## Format all sources in place
	@cmake/debian-packages.sh format
	@clang-format -i $(SOURCES)

format-check: ## Say which sources `make format` would change
	@cmake/debian-packages.sh format
	@clang-format --dry-run -Werror $(SOURCES)

tidy: configure ## Look for mistakes with clang-tidy; silent if there are none. CHANGED=1: in what changed, TIDY_SECONDS=60 long
	@cmake/debian-packages.sh tidy
	@cmake --build $(BUILD) --target talus_version
	@cmake/tidy.sh $(BUILD) $(JOBS) $(if $(CHANGED),$(TIDY_SECONDS))

clean: ## Remove what `make` built (not the runs)
	@rm -rf $(BUILD) $(SANITIZE) $(BUILD)-fuzz
