# One import an entry and one name an import: lazy_loader reads these lines.
from .figures import figure_of as figure_of
from .figures import figures_of as figures_of
from .figures import write_pictures as write_pictures
from .files import writes_dxf as writes_dxf
from .files import write_record as write_record
from .files import write_summary as write_summary
from .files import write_table as write_table
from .files import write_tables as write_tables
from .hypertext import figure_html as figure_html
from .hypertext import rows_html as rows_html
from .hypertext import sheet_html as sheet_html
from .markup import page_text as page_text
from .plain_table import aligned as aligned
from .terminal import fact_rows as fact_rows
from .terminal import facts_text as facts_text
from .terminal import sheet_text as sheet_text
from .terminal import plain_text as plain_text
