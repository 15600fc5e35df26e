// Scrolling elements can be scrolled by keyboard, too; figures scroll only in narrow windows.
document$.subscribe(() =>
  document.querySelectorAll(".md-typeset :is(pre > code, .md-typeset__scrollwrap, p:has(> img))")
    .forEach(part => { if (part.tagName !== "P" || part.scrollWidth > part.clientWidth) part.tabIndex = 0; }));
