"""Put the chunks of a training together."""

import pyarrow as pa
import pyarrow.parquet as pq

from recalib.learned import join
from recalib.storage import whole
from workflow.scripts.job import job

with job(snakemake):
    with whole(snakemake.output.history) as path:
        pq.write_table(pa.concat_tables(map(pq.read_table, snakemake.input.histories)), path)
    join(snakemake.output.learned, snakemake.input.learned)
