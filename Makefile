.PHONY: demo quick test test-containers format clean
# Everything a fresh machine needs: python3 and make.

demo: ## installs, serves, a real flight is flying; the address is printed once it answers
	@tools/demo

quick: ## the gates that take a minute: format, lint, imports, types, the console's, the house's
	@GATES=quick tools/setup dev
	@tools/gates quick

test: ## installs what the tests need and runs every gate
	@tools/setup dev
	@tools/gates $(GATES)

test-containers: ## as root: builds the image with podman, and runs it, its proxy and Prometheus in real containers
	@tools/containers

format: ## puts the sources in order
	@.venv/bin/ruff format . && .venv/bin/ruff check --fix .
	@.venv/bin/python hatch_build.py --format

clean: ## removes what set-up and tests made
	rm -rf .venv .make build dist server/fullpose_server/console web/node_modules .mypy_cache .ruff_cache .pytest_cache .hypothesis
	find solver server -name __pycache__ -prune -exec rm -rf {} +
