"""Put the chunks of a table together."""

import pyarrow as pa
import pyarrow.parquet as pq

from recalib.storage import whole
from workflow.scripts.job import job

with job(snakemake), whole(snakemake.output[0]) as path:
    pq.write_table(pa.concat_tables(map(pq.read_table, snakemake.input.chunks)), path)
