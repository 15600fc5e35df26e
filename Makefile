# make: set up and replicate everything. make test: linters and most tests. make help: what else there is.
PYTHON ?= python3
CORES ?= 2
COUNT ?= 20
PORT ?= 9090
STUDY ?= replication
RESULTS = $(if $(filter replication,$(STUDY)),results,results/studies/$(STUDY))
STUDY_FILE = $(firstword $(wildcard $(STUDY).yaml workflow/studies/$(STUDY).yaml))
SNAKEMAKE = .venv/bin/snakemake --cores $(CORES) $(addprefix --configfile ,$(STUDY_FILE))
RECORDINGS = $(RESULTS)/recordings
RECORDING = $(firstword $(SCENARIO:%=$(RECORDINGS)/%.rrd) \
  $(wildcard $(RECORDINGS)/links_encoders.rrd $(RECORDINGS)/*.rrd) $(RECORDINGS)/links_encoders.rrd)
PIP = .venv/bin/python -m pip install --quiet --disable-pip-version-check
UV = .venv/bin/uv --quiet --no-python-downloads
ELSEWHERE = folder=$$(mktemp -d) && trap 'rm -r "$$folder"' EXIT

.PHONY: all help quick study setup cluster vision lint test test-all dist elsewhere lowest slurm faults verify mutants peers check bench report article archive docs pictures view web notebook tune design power reference universes horizons ship lock clean

all: setup ## the full replication
	$(SNAKEMAKE)

help: ## this list
	@sed -n 's/^\([a-z-]*\):.*## /\1|/p' $(MAKEFILE_LIST) | tr '|' '\t' | expand -t 12

quick: STUDY = quick
quick: study ## the replication in small, in a minute: results/studies/quick

study: setup ## a study of workflow/studies or of your own: make study STUDY=my_arm; see docs/bend.md
	$(if $(STUDY_FILE),,$(error there is no $(STUDY).yaml; see docs/bend.md))
	$(SNAKEMAKE) --quiet rules reason host
	$(SNAKEMAKE) --quiet all --report $(RESULTS)/report.html --report-stylesheet workflow/report/style.css

setup: .venv/installed ## the environment, from the lock file

.venv/installed: requirements.lock pyproject.toml
	@$(PYTHON) -c 'import sys; (3, 11) <= sys.version_info < (3, 14) or sys.exit(f"$(PYTHON) is Python \
	{sys.version.split()[0]}; expected: 3.11 to 3.13; try: make PYTHON=python3.12")'
	$(PYTHON) -m venv .venv
	$(PIP) --require-hashes -r requirements.lock
	$(PIP) --no-index --no-build-isolation --no-deps --editable .
	touch $@

cluster: setup ## what Snakemake needs to talk to Slurm, not pinned; see docs/cluster.md
	$(PIP) --no-build-isolation --editable .[cluster]

vision: setup ## what pictures of a board need, OpenCV, not pinned; see docs/pictures.md
	$(PIP) --no-build-isolation --editable .[vision]

test: lint ## the linters and all tests but whole workflows, examples, sites and environments
	.venv/bin/python -m pytest -m "not slow"

test-all: lint ## the linters and all tests
	.venv/bin/python -m pytest

lint: setup ## the linters and the types of the library
	.venv/bin/ruff check .
	.venv/bin/ruff format --check .
	.venv/bin/mypy
	.venv/bin/snakefmt --check Snakefile workflow/rules

dist: setup ## what is released, the sources and the wheel, in dist/
	rm -rf dist
	.venv/bin/python -m build --no-isolation --outdir dist
	$(UV) tool run twine check --strict dist/*

elsewhere: dist ## the sources that are released, unpacked elsewhere: make test and make quick; PYTHON=python3.13 for another Python
	$(ELSEWHERE) && tar --extract --file dist/recalib-*.tar.gz --directory "$$folder" --strip-components 1 && \
	  make --directory "$$folder" PYTHON=$(PYTHON) test quick

lowest: setup ## the library's tests with the lowest versions that pyproject.toml allows
	$(ELSEWHERE) && $(UV) venv --python .venv/bin/python "$$folder" && \
	  $(UV) pip install --python "$$folder" --resolution lowest-direct .[laboratory,study,dev] && \
	  "$$folder/bin/python" -m pytest -m "not slow" $(addprefix tests/,damaged identification laboratory learners nominal)

slurm: setup ## a small campaign on a Slurm of one node, with faults; says what it lacks
	.venv/bin/python -m pytest -n0 -rs tests/slurm

faults: setup ## what befalls a run: killed, two at once, damaged files, disk full; prints a table
	.venv/bin/python -m tests.faults --cores $(CORES)

verify: setup ## whether all results are as they were written; what is not is removed
	.venv/bin/python -m workflow.digests results

mutants: setup ## plant small errors that nobody chose, and say what no test notices: docs/mutants.md
	$(PIP) --no-build-isolation --editable .[mutants]
	.venv/bin/python -m tests.mutants --count $(COUNT)

peers: setup ## our calibration beside figaroh's and robotkinecal's, each in an environment of its own: docs/peers.md
	.venv/bin/python -m tests.peers $(addprefix --recording ,$(RECORDED))

check: setup ## the final errors against their bands, by themselves
	$(SNAKEMAKE) --forcerun check -- $(RESULTS)/check.txt

bench: setup ## moves a second, and the ratio to a bare loop
	$(SNAKEMAKE) --forcerun bench -- $(RESULTS)/bench.txt

report: all ## everything in one file to look at, results/report.html
	$(SNAKEMAKE) --report $(RESULTS)/report.html --report-stylesheet workflow/report/style.css -- all $(wildcard $(RESULTS)/figures/arm_*.png)

article: all ## the article, results/article.pdf
	$(SNAKEMAKE) -- results/article.pdf

archive: report article ## code, results, recordings and article in one file, results/archive.zip
	.venv/bin/python -m workflow.archive results/archive.zip

docs: setup ## these pages and a reference as a site, results/site/index.html
	NO_MKDOCS_2_WARNING=1 .venv/bin/mkdocs build --quiet --strict

pictures: setup ## the arm before and after, and a film; SCENARIO: of another one; needs mesa-vulkan-drivers or another Vulkan driver
	$(SNAKEMAKE) --forcerun before_and_after film -- \
	  $(if $(SCENARIO),$(addprefix $(RESULTS)/figures/$(SCENARIO),_before.png .webp),pictures)

view: setup ## open a recording; make view SCENARIO=noise or STUDY=ur3 opens another one
	$(SNAKEMAKE) --quiet all -- $(RECORDING)
# with CI, the viewer neither notes who runs it nor tells its makers
	CI=true .venv/bin/rerun --bind 127.0.0.1 --new $(RECORDING) \
	  || { echo "No display for a window here? make web shows the same in a browser."; exit 1; }

web: setup ## recordings and report in a browser, from a server as well; SCENARIO and STUDY as above
	$(SNAKEMAKE) --quiet all -- $(RECORDING)
	.venv/bin/python -m workflow.watch $(RESULTS) --port $(PORT)

notebook: setup ## damage an arm with sliders, in a browser; installs marimo, not pinned
	$(PIP) --no-build-isolation --editable .[notebook]
	MARIMO_SKIP_UPDATE_CHECK=1 .venv/bin/marimo run --host 127.0.0.1 --port $(PORT) examples/notebook.py

tune: setup ## repeat all searches for widths and rates, and ship what is found
	$(SNAKEMAKE) tune
	cp results/search/*.csv workflow/search/

design: setup ## draw the universes anew, and ship them
	$(SNAKEMAKE) --forcerun design -- results/universes/design.csv
	mkdir -p workflow/universes/second
	cp results/universes/design.csv workflow/universes/second/

power: setup ## try the model of the campaign in worlds whose truth is known, and ship what it finds (10 minutes)
	$(SNAKEMAKE) -- results/universes/power.csv
	cp results/universes/power.csv workflow/universes/second/

reference: setup ## measure the reference study as the universes are, and ship it (40 minutes)
	$(SNAKEMAKE) -- results/universes/reference.csv results/universes/efforts.csv
	cp results/universes/reference.csv results/universes/efforts.csv workflow/universes/second/

universes: setup ## measure all universes of the design, or PIECE=0 or 1 of them, and ship them (half an hour a piece)
	$(SNAKEMAKE) $(if $(PIECE),-- results/universes/outcomes_$(PIECE).csv,universes)
	cp results/universes/outcomes_$(or $(PIECE),*).csv workflow/universes/second/

horizons: setup ## how long Ritter's map takes in universes, or in PIECE=0 to 3 of them (half an hour a piece)
	$(SNAKEMAKE) $(if $(PIECE),-- results/universes/horizon_$(PIECE).csv,horizons)
	cp results/universes/horizon_$(or $(PIECE),*).csv workflow/universes/second/

ship: setup ## make config.yaml, as it now is, the shipped study
	.venv/bin/python -m recalib.study.ship

lock: setup ## pin the dependencies of pyproject.toml anew
	.venv/bin/uv pip compile pyproject.toml --extra study --extra dev --extra docs --extra article --universal --generate-hashes \
	  --no-emit-index-url --python-version 3.11 --custom-compile-command "make lock" \
	  --output-file requirements.lock

clean: ## remove results, keep the environment
	rm -rf results .snakemake
