# make: set up and replicate everything. make test: linters and tests. make help: what else there is.
PYTHON ?= python3
CORES ?= 2
SCENARIO ?= links_encoders
STUDY ?= replication
RESULTS = $(if $(filter replication,$(STUDY)),results,results/studies/$(STUDY))
SNAKEMAKE = .venv/bin/snakemake --cores $(CORES)
PIP = .venv/bin/python -m pip install --quiet --disable-pip-version-check

.PHONY: all help setup cluster test slurm check bench report pictures view tune design universes ship lock clean

all: setup ## the full replication
	$(SNAKEMAKE)

help: ## this list
	@sed -n 's/^\([a-z]*\):.*## /\1|/p' $(MAKEFILE_LIST) | tr '|' '\t' | expand -t 12

setup: .venv/installed ## the environment, from the lock file

.venv/installed: requirements.lock pyproject.toml
	$(PYTHON) -m venv .venv
	$(PIP) --require-hashes -r requirements.lock
	$(PIP) --no-index --no-build-isolation --no-deps --editable .
	touch $@

cluster: setup ## what Snakemake needs to talk to Slurm, not pinned; see docs/cluster.md
	$(PIP) --no-build-isolation --editable .[cluster]

test: setup ## the linters and all tests
	.venv/bin/ruff check .
	.venv/bin/ruff format --check .
	.venv/bin/python -m pytest

slurm: setup ## a small campaign on a Slurm of one node, with faults; says what it lacks
	.venv/bin/python -m pytest -n0 -rs tests/slurm

check: setup ## the final errors against their bands, by themselves
	$(SNAKEMAKE) --forcerun check -- $(RESULTS)/check.txt

bench: setup ## moves a second, and the ratio to a bare loop
	$(SNAKEMAKE) --forcerun bench -- $(RESULTS)/bench.txt

report: all ## everything in one file to look at, results/report.html
	$(SNAKEMAKE) --report results/report.html -- all $(wildcard results/figures/arm_*.png)

pictures: setup ## the arm before and after; needs a Vulkan driver, such as mesa-vulkan-drivers
	$(SNAKEMAKE) --forcerun before_and_after -- pictures

view: setup ## open a recording; make view SCENARIO=noise or STUDY=ur3 opens another one
	$(SNAKEMAKE) $(RESULTS)/recordings/$(SCENARIO).rrd
	.venv/bin/rerun --bind 127.0.0.1 $(RESULTS)/recordings/$(SCENARIO).rrd

tune: setup ## repeat all searches for widths and rates, and ship what is found
	$(SNAKEMAKE) tune
	cp results/search/*.csv workflow/search/

design: setup ## draw the universes anew, and ship them
	$(SNAKEMAKE) --forcerun design -- results/universes/design.csv
	mkdir -p workflow/universes
	cp results/universes/design.csv workflow/universes/

universes: setup ## measure every universe of the design, and ship what was measured
	$(SNAKEMAKE) universes
	cp results/universes/outcomes.csv workflow/universes/

ship: setup ## make config.yaml, as it now is, the shipped study
	.venv/bin/python -m recalib.study.ship

lock: ## pin the dependencies of pyproject.toml anew (needs uv)
	uv pip compile pyproject.toml --extra study --extra dev --universal --generate-hashes \
	  --no-emit-index-url --python-version 3.11 --custom-compile-command "make lock" \
	  --output-file requirements.lock

clean: ## remove results, keep the environment
	rm -rf results .snakemake
