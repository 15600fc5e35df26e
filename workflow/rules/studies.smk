"""What a study consists of, a target for each of them, and what the shipped one publishes."""


def everything(root):
    """All results of a study, and what is made of them."""
    its, study_ = Layout(root), STUDIES[root]
    wanted = [its.summary, *figures_of(root), *recordings_of(root), *report_of(root)]
    if study_.expected:
        wanted.append(its.check)
    if study_.experiments.evidence:
        wanted += [its.claims, its.page("README.md"), its.page("findings.md")]
    return [*wanted, *published(root, wanted)]


PAGES = {"README.md": "README.md", "docs/findings.md": "findings.md", "docs/guidance.md": "guidance.md"}


def published(root, made):
    """The committed files that are copies of what was made: of the shipped study's, and of no other."""
    if root != RESULTS:
        return []
    its = Layout(root)
    pages = [target for target, page in PAGES.items() if its.page(page) in made]
    return [*pages, *(f"figures/{Path(path).name}" for path in made if Path(path).parts[-2] == "figures")]


# A copy takes no time: the committed file is there but for a moment, whatever its drawing comes to.
rule publish_figure:
    input:
        Layout(RESULTS).figure("{figure}", ".{suffix}"),
    output:
        "figures/{figure}.{suffix}",
    wildcard_constraints:
        suffix="svg|png",
    message:
        "Publish {output}"
    shell:
        "cp {input} {output}"


rule publish_page:
    input:
        lambda w: Layout(RESULTS).page(PAGES[w.page]),
    output:
        "{page}",
    wildcard_constraints:
        page="|".join(PAGES),
    message:
        "Publish {output}"
    shell:
        "cp {input} {output}"


for root in STUDIES:
    if root != MAIN:

        rule:
            name:
                STUDIES[root].name
            input:
                everything(root),
            message:
                f"All results are in {root}"
