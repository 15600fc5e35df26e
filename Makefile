# make: set up and replicate everything. make test: linters and tests. The other targets say what they do below.
PYTHON ?= python3
CORES ?= 2
SCENARIO ?= links_encoders
SNAKEMAKE = .venv/bin/snakemake --cores $(CORES)

.PHONY: all setup test check bench report pictures view tune lock clean

all: setup ## the full replication
	$(SNAKEMAKE)

setup: .venv/installed ## the environment, from the lock file

.venv/installed: requirements.lock pyproject.toml
	$(PYTHON) -m venv .venv
	.venv/bin/python -m pip install --quiet --disable-pip-version-check --require-hashes -r requirements.lock
	.venv/bin/python -m pip install --quiet --disable-pip-version-check --no-index --no-build-isolation --no-deps --editable .
	touch $@

test: setup ## the linters and all tests
	.venv/bin/ruff check .
	.venv/bin/ruff format --check .
	.venv/bin/python -m pytest

check: setup ## the final errors against their bands, by themselves
	$(SNAKEMAKE) --forcerun check -- check

bench: setup ## moves a second, and the ratio to a bare loop
	$(SNAKEMAKE) --forcerun bench -- bench

report: all ## everything in one file to look at, results/report.html
	$(SNAKEMAKE) --report results/report.html -- all $(wildcard figures/arm_*.png)

pictures: setup ## the arm before and after in the viewer; needs a Vulkan driver, such as Debian's mesa-vulkan-drivers
	$(SNAKEMAKE) --forcerun pictures -- pictures

view: setup ## open a recording in the viewer; make view SCENARIO=rotation shows another one
	$(SNAKEMAKE) results/recordings/$(SCENARIO).rrd
	.venv/bin/rerun --bind 127.0.0.1 results/recordings/$(SCENARIO).rrd

tune: setup ## repeat the search for widths and rates from scratch
	$(SNAKEMAKE) tune

lock: ## pin the dependencies of pyproject.toml anew (needs uv)
	uv pip compile pyproject.toml --extra study --extra dev --universal --generate-hashes --no-emit-index-url --python-version 3.11 \
	  --custom-compile-command "make lock" --output-file requirements.lock

clean: ## remove results, keep the environment
	rm -rf results .snakemake
