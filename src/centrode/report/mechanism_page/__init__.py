"""A mechanism that a reader can touch: one page that computes the motion itself."""

from centrode.report.mechanism_page.page_file import mechanism_page as mechanism_page
